// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/calibration.hpp>

namespace crisp::calibrate {

/// Two parameters whose errors go together.
struct Correlation {
  std::string one;
  std::string other;
  double value = 0;  ///< −1 to 1
};

/// The pairs of a calibration's free parameters that are correlated most, the strongest first.
///
/// @param least  [0, 1] of the absolute value
std::vector<Correlation> strongest_correlations(const Calibration& calibration, std::size_t most,
                                                double least);

}  // namespace crisp::calibrate
