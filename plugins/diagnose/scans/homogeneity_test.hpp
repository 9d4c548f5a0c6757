// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace crisp::diagnose {

/// An estimate and its standard error.
using ValueWithError = std::pair<double, double>;

/// Null hypothesis: all values are zero, or equal to their weighted mean.
enum class Level { kZero, kMean };

/// Heterogeneity of values about a level.
struct HomogeneityTest {
  double beyond = 0;   ///< between-value variance: mean square less the mean squared error
  double p_value = 1;  ///< under homogeneity; 1 without values to compare
  double log10_bayes_factor =
      0;  ///< log10 of the Bayes factor (BIC) of individual values against the common level
  bool compared = false;
};

/// Tests values for homogeneity (Cochran's Q). Each standard error is estimated from a number of blocks, so
/// the statistic is compared with F in place of χ², and the likelihood is Student's t. Values or errors that
/// are not finite are left out.
HomogeneityTest homogeneity_test(std::vector<ValueWithError> values, Level level, std::size_t blocks);

}  // namespace crisp::diagnose
