// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>

#include "plugins/diagnose/noise/noise_model.hpp"

namespace crisp::diagnose {

/// One extension of the normal noise model.
struct NoiseComponent {
  std::string cause;                        ///< name in the catalogue; empty for a mere description
  std::function<void(NoiseModel&)> add;     ///< sets the start values of its fit
  std::function<void(NoiseModel&)> remove;  ///< removes it from the model
  std::function<std::vector<Parameter>(const NoiseModel&)> parameters;
  /// Further parameters with standard errors, estimated from the ranges after the fit; may be null.
  std::function<std::vector<Parameter>(const NoiseModel&, const RangeErrors&)> determined_by_ranges = nullptr;
};

/// Whether the values can serve as a covariate: there are some, and they vary.
bool are_various(std::span<const float> values);

/// Noise components that these errors can identify: those whose covariate is known and varies.
///
/// @param sigma  [m] of the normal noise model, for start values
std::vector<NoiseComponent> noise_components(const RangeErrors& errors, double sigma);

}  // namespace crisp::diagnose
