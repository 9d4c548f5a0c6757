// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "pipeline/statistics/random_stream.hpp"

namespace crisp::statistics {

/// Draws blocks of `block` neighbours, with replacement, as many as there are: what neighbours share (a
/// surface, a burst) they then share in every draw (moving block bootstrap, Künsch 1989).
class BlockDraws {
 public:
  BlockDraws(std::size_t size, std::size_t block, std::uint64_t seed)
      : size_(size),
        block_(std::clamp<std::size_t>(block, 1, std::max<std::size_t>(size, 1))),
        random_(seed, "bootstrap") {}

  std::vector<std::size_t> draw() {
    std::vector<std::size_t> picked;
    while (picked.size() < size_) {
      const std::size_t begin = random_.below(size_ - block_ + 1);
      for (std::size_t k = 0; k < block_ && picked.size() < size_; ++k) picked.push_back(begin + k);
    }
    return picked;
  }

 private:
  std::size_t size_;
  std::size_t block_;
  RandomStream random_;
};

struct Spread {
  double std_error = 0;
  std::array<double, 2> ci95{};
};

/// Spread of a statistic of `size` values over bootstrap draws of blocks of them.
inline Spread bootstrap(std::size_t size, std::size_t block, std::uint64_t seed, std::size_t draws,
                        const std::function<double(const std::vector<std::size_t>&)>& statistic) {
  if (size == 0) return {};
  BlockDraws blocks(size, block, seed);
  std::vector<double> values;
  for (std::size_t i = 0; i < draws; ++i) {
    const double value = statistic(blocks.draw());
    if (std::isfinite(value)) values.push_back(value);
  }
  if (values.size() < 2) return {};
  std::sort(values.begin(), values.end());
  double mean = 0, squares = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) squares += (value - mean) * (value - mean);
  constexpr double kTail = 0.025;
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {.std_error = std::sqrt(squares / static_cast<double>(values.size() - 1)),
          .ci95 = {at(kTail), at(1 - kTail)}};
}

}  // namespace crisp::statistics
