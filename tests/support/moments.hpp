// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace crisp::test {

constexpr int kDraws = 200'000;

struct Moments {
  double mean = 0;
  double variance = 0;
  double kurtosis = 0;  ///< of the fourth moment about zero
};

/// Moments of kDraws draws.
inline Moments moments(const std::function<double()>& draw) {
  double s1 = 0, s2 = 0, s4 = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = draw();
    s1 += x;
    s2 += x * x;
    s4 += x * x * x * x;
  }
  const double mean = s1 / kDraws;
  const double variance = s2 / kDraws - mean * mean;
  return {.mean = mean, .variance = variance, .kurtosis = s4 / kDraws / variance / variance};
}

}  // namespace crisp::test
