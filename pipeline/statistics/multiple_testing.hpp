// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace crisp::statistics {

/// Šidák-corrected p-value of the smallest of a number of independent p-values.
inline double sidak_p_value(double tests, double p_value) {
  return -std::expm1(tests * std::log1p(-p_value));
}

/// Effective number of independent tests, by maximum likelihood from simulated least p-values: the least one
/// is below p with a probability of 1 − (1 − p)ᵐ. Tests of the same beams, less what was fitted to them,
/// count as fewer than they are.
inline double effective_number_of_tests(const std::vector<double>& least) {
  double sum = 0;
  for (const double chance : least) sum += std::log1p(-std::min(chance, 1 - 1e-9));
  return -static_cast<double>(least.size()) / sum;
}

}  // namespace crisp::statistics
