// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace crisp {

/// A stream of random numbers that is the same on every platform: the engine is fixed by the C++ standard,
/// the transformations (which the standard leaves open) are here. Streams of different names are independent,
/// so that what one device draws does not depend on what another one did.
class RandomStream {
 public:
  /// @param seed  of the whole simulation
  /// @param name  what the stream is for, "laser1.noise"
  RandomStream(std::uint64_t seed, std::string_view name);

  double uniform();                         ///< in [0, 1)
  double uniform(double low, double high);  ///< in [low, high)
  double normal();                          ///< mean 0, variance 1, by the polar method of Marsaglia and Bray
  double exponential(double mean);          ///< ≥ 0
  bool chance(double probability);          ///< true with this probability
  std::uint64_t bits() { return engine_(); }  ///< 64 random bits

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace crisp
