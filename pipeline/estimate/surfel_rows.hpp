// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfel_equations.hpp"

namespace crisp {

/// How the model's free parameters move a sample's points across surfels: normal · ∂x/∂θ, there where each
/// beam meets the surfel's plane. Refers to all that it is given, which must outlive it.
///
/// @param free  m indices into model.values()
DerivativeRows surfel_rows(const SensorModel& model, const Sample& sample,
                           const std::vector<std::size_t>& free);

}  // namespace crisp
