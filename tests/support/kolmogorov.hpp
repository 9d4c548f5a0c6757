// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace crisp::test {

inline constexpr double kUnevenOnceInAThousand = 1.95;

/// √n times the largest difference of the distribution of n p-values from an even one (Kolmogorov).
inline double unevenness(std::vector<double> chances) {
  std::ranges::sort(chances);
  const auto n = static_cast<double>(chances.size());
  double most = 0;
  for (std::size_t k = 0; k < chances.size(); ++k) {
    for (const std::size_t below : {k, k + 1}) {
      most = std::max(most, std::abs(chances[k] - static_cast<double>(below) / n));
    }
  }
  return std::sqrt(n) * most;
}

/// Their tenths: "0.1 0.19 …".
inline std::string in_words(std::vector<double> chances) {
  std::ranges::sort(chances);
  std::string words;
  for (std::size_t tenth = 0; tenth <= 10; ++tenth) {
    words += std::to_string(chances[(chances.size() - 1) * tenth / 10]) + " ";
  }
  return words;
}

}  // namespace crisp::test
