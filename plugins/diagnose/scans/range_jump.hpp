// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "plugins/diagnose/scans/scan_series.hpp"

namespace crisp::diagnose {

/// [m] Largest common-mode change of the ranges between consecutive scans: median over the beams, less half
/// of the changes before and after it. It is the detection limit of a range step.
///
/// @param scans  of one laser in order, with a moving or a stationary actuator
/// @return       empty without four scans in which ten beams, and a quarter of them, have echoes
std::optional<double> largest_jump(const std::vector<SeriesScan>& scans);

}  // namespace crisp::diagnose
