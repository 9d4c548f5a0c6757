// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "plugins/calibrate/grid_search.hpp"
#include "plugins/calibrate/rqe_minimizer.hpp"

namespace crisp::calibrate {

struct InPlaneSettings {
  double half_width = 0.0044;  ///< [rad] beams so near to the plate's plane count as in it
  double sigma_from = 0.5;     ///< [m]
  double sigma_to = 0.1;       ///< [m]
  estimate::ParameterPrior range;
  MinimizerSettings minimizer;
};

/// With fewer beams of a laser there is nothing to align.
inline constexpr std::size_t kFewBeams = 20;

/// Whether the beams in the plate's plane see walls as isolated spots: in directions 5° apart and more. With
/// commensurate rates of plate and mirrors, 2 and 50 Hz for example, the beams' directions repeat for ever;
/// the RQE of single spots does not determine a calibration (found at 25 a turn: τ off by 0.3 m; at 50:
/// right).
///
/// @param sample  all its beams are covered by encoder readings
bool sees_single_spots(const estimate::Sample& sample, const InPlaneSettings& settings);

/// A first calibration in the paper's order, from the two beams of each laser that lie in the plate's plane:
///   1. each η from the front beam alone, with τ and α as they are: the turns of the plate must agree;
///   2. each laser's τ and α from its front and back beams;
///   3. each λ against the first laser, from any start: a search over the whole circle, then downhill;
///      (of a plate that turns both ways 1 and 3 go by minimize_wall_residual(), from where the kernel has η)
///   4. all 3n − 1 geometric parameters together.
/// Leaves the model at what it found.
///
/// @param free    indices into model.values(); others stay as they are
/// @param sample  covered for every η in the range
/// @return  competing minima of η and λ, the next lowest of each
std::vector<CompetingMinimum> calibrate_in_plane(SensorModel& model, const std::vector<std::size_t>& free,
                                                 const estimate::Sample& sample, Measure& measure,
                                                 const InPlaneSettings& settings);

}  // namespace crisp::calibrate
