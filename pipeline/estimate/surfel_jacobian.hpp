// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfel_equations.hpp"

namespace crisp {

/// Derivatives of a sample's points across surfels by the model's free parameters: normal · ∂x/∂θ, at each
/// beam's intersection with the surfel's plane. Refers to its arguments, which must outlive it.
///
/// @param free  m indices into model.values()
DerivativeRows surfel_rows(const SensorModel& model, const Sample& sample,
                           const std::vector<std::size_t>& free);

}  // namespace crisp
