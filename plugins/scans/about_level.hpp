// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace crisp {

using ValueWithError = std::pair<double, double>;

enum class Level { kZero, kMean };

/// How values lie about a level.
struct AboutLevel {
  double beyond = 0;      ///< mean of the squares, less those of the errors
  double p_value = 1;     ///< that the errors alone make as much; 1 where there is nothing to compare
  double log10_odds = 0;  ///< of each value as it is, against all of them at the level, by BIC
  bool compared = false;
};

/// Whether values differ from zero, or from their own weighted mean, by their errors alone. The errors are
/// themselves known by so many blocks only that each value was told by: hence F, and Student's t in place of
/// the normal law. Values or errors that could not be told do not count.
AboutLevel about_level(std::vector<ValueWithError> values, Level level, std::size_t blocks);

}  // namespace crisp
