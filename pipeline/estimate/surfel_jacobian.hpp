// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfel_equations.hpp"

namespace crisp::estimate {

/// Derivatives of a sample's points across surfels by the model's free parameters: normal · ∂x/∂θ, at each
/// beam's intersection with the surfel's plane. Refers to its arguments, which must outlive it.
///
/// @param free  m indices into model.values()
quality::DerivativeRows surfel_rows(const SensorModel& model, const Sample& sample,
                                    const std::vector<std::size_t>& free);

/// Some beams of `from`, with changed ranges.
///
/// @param range_change  [m] for each of `beams`
Measurements with_range_changes(const Measurements& from, std::span<const std::uint32_t> beams,
                                std::span<const double> range_change);

/// Sets rows[row of the beam · stride + column] to normal · ∂x/∂θ [m] for the parameters `free`.
///
/// @param columns  one for each of `free`
void fill_surfel_rows(const SensorModel& model, const Measurements& beams, const PlateTrajectory& plate,
                      const std::vector<std::size_t>& free, const Eigen::Vector3d& normal,
                      const std::vector<std::size_t>& columns, std::size_t stride, std::span<double> rows);

}  // namespace crisp::estimate
