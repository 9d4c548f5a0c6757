// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/model/sensor_model.hpp"
#include "plugins/calibrate/deepest_valley.hpp"

namespace crisp {

/// What it takes to draw a plane cloud by straight runs (straight_runs()), in squares of `noise`: little
/// where the turns of the plate agree. Other than under a kernel, spots far from one another do not count for
/// falling together by chance.
///
/// @param sample  beams in the plate's plane, all of which the plate's readings cover
/// @param noise   [m] that runs may be missed by
double straightness(const SensorModel& model, const Sample& sample, double noise);

/// Whether the plate turned in both senses while the beams were fired, a tenth of its way at least.
bool turns_both_ways(const Sample& sample);

/// [s] From one scan to the next, of beams of one laser in the order in which they were fired; half of them
/// follow sooner.
double between_scans(const Sample& own);

/// The value of one parameter, others as they are, at which walls are straightest. A plate that turns to and
/// fro and looks into few directions bunches its spots: at lags half a scan apart those of one sense of
/// rotation fall onto those of the other. A kernel takes that for crisp, and the truth may be in between.
///
/// @param grid      evenly spaced, as fine as three times the noise displaces the cloud
/// @param circular  whether its last value is next to its first
/// @param noise     [m] as of straightness()
/// @return          where walls are next to as straight, if anywhere; its height is half the logarithm of the
///                  ratio of both, what a beam's log-likelihood loses
std::optional<Rival> to_straightest(SensorModel& model, std::size_t parameter,
                                    const std::vector<double>& grid, bool circular, const Sample& sample,
                                    double noise);

}  // namespace crisp
