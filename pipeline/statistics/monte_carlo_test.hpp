// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace crisp::statistics {

/// Result of a Monte Carlo test.
struct MonteCarloTest {
  double p_value = 1;
  double mean = 0;  ///< of the statistic over the draws
};

/// Monte Carlo test, such as a permutation test. The p-value is the share of the draws whose statistic
/// reaches the observed one, with the observation counted as a draw: it is never 0, and of the stated level
/// for any number of draws (Davison and Hinkley, Bootstrap Methods and their Application, 1997, section 4.2).
///
/// @param draw  returns the statistic of the next draw under the null hypothesis
template <class Draw>
MonteCarloTest monte_carlo_test(double observed, std::size_t draws, Draw draw) {
  MonteCarloTest test;
  std::size_t reached = 0;
  for (std::size_t i = 0; i < draws; ++i) {
    const double statistic = draw();
    test.mean += statistic / static_cast<double>(draws);
    if (statistic >= observed) ++reached;
  }
  test.p_value = static_cast<double>(reached + 1) / static_cast<double>(draws + 1);
  return test;
}

}  // namespace crisp::statistics
