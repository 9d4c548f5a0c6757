// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace crisp {

/// That the least of some independent chances is as small as this one.
inline double least_of(double looks, double chance) { return -std::expm1(looks * std::log1p(-chance)); }

/// Of how many independent looks the least chances of simulations are the least, by maximum likelihood: a
/// chance below p is then met with a probability of 1 − (1 − p)ᵐ. Looks at the same beams, less what was
/// fitted to them, count as fewer than they are.
inline double independent_looks(const std::vector<double>& least) {
  double sum = 0;
  for (const double chance : least) sum += std::log1p(-std::min(chance, 1 - 1e-9));
  return -static_cast<double>(least.size()) / sum;
}

}  // namespace crisp
