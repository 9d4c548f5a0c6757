// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace crisp {

/// The number congruent to `residue` modulo `modulus` that is nearest to `expected`: unwraps a counter.
inline double nearest_congruent(double residue, double modulus, double expected) {
  return residue + modulus * std::round((expected - residue) / modulus);
}

}  // namespace crisp
