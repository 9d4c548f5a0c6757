// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <crisp/sensor_model.hpp>

#include "pipeline/estimate/sample.hpp"
#include "plugins/calibrate/grid_search.hpp"

namespace crisp::calibrate {

/// Cost of a plane cloud's segmentation into straight runs (straight_runs()), in squares of `noise`: low
/// if the turns of the plate agree. Unlike under a kernel, chance coincidence of separate spots does not
/// count.
///
/// @param sample  beams in the plate's plane, all of which encoder readings cover
/// @param noise   [m] standard deviation of points about runs
double wall_straightness(const SensorModel& model, const estimate::Sample& sample, double noise);

/// Whether the plate turned in both senses while the beams were fired, a tenth of its way at least.
bool turns_both_ways(const estimate::Sample& sample);

/// [s] From one scan to the next, of beams of one laser in the order in which they were fired; half of them
/// follow sooner.
double between_scans(const estimate::Sample& own);

/// Minimizes the residual of straight walls over one parameter, the others held. A plate that turns to and
/// fro with few beam directions bunches its spots: at lags half a scan apart those of one sense of rotation
/// coincide with those of the other. A kernel has a spurious minimum there, and the truth may be in between.
///
/// @param grid      evenly spaced, as fine as three times the noise displaces the cloud
/// @param circular  whether its last value is next to its first
/// @param noise     [m] as of wall_straightness()
/// @return          a competing minimum with nearly as straight walls, if any; its height is half the
/// logarithm of the ratio of both, the difference of a beam's log-likelihood
std::optional<CompetingMinimum> minimize_wall_residual(SensorModel& model, std::size_t parameter,
                                                       const std::vector<double>& grid, bool circular,
                                                       const estimate::Sample& sample, double noise);

}  // namespace crisp::calibrate
