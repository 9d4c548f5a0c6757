// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>
#include <utility>

namespace crisp::statistics {

/// A stream of random numbers that is the same on every platform: the engine is fixed by the C++ standard,
/// the transformations (which the standard leaves open) are here. Streams of different names are independent,
/// so that what one device draws does not depend on what another one did.
class RandomStream {
 public:
  /// @param seed  of the whole run
  /// @param name  what the stream is for, "laser1.noise"
  RandomStream(std::uint64_t seed, std::string_view name);

  double uniform();                         ///< in [0, 1)
  double uniform(double low, double high);  ///< in [low, high)
  double normal();                          ///< mean 0, variance 1, by the polar method of Marsaglia and Bray
  double exponential(double mean);          ///< ≥ 0
  bool chance(double probability);          ///< true with this probability
  double sign();                            ///< −1 or 1
  /// 0 to n − 1, each as often. @param n  1 or more
  std::size_t below(std::size_t n);
  std::uint64_t bits() { return engine_(); }  ///< 64 random bits

  /// Puts the elements in an order of which each is as likely (Fisher and Yates).
  template <class Elements>
  void shuffle(Elements& elements) {
    for (auto n = static_cast<std::size_t>(std::size(elements)); n > 1; --n) {
      const auto begin = std::begin(elements);
      std::swap(*(begin + static_cast<std::ptrdiff_t>(n - 1)),
                *(begin + static_cast<std::ptrdiff_t>(below(n))));
    }
  }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace crisp::statistics
