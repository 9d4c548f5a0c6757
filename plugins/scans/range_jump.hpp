// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "plugins/scans/scan_series.hpp"

namespace crisp {

/// [m] By how much ranges change at once from one scan to the next, at the most: median over the beams, less
/// half of what they change by before and after it. A jump of all ranges that is no larger does not show.
///
/// @param scans  of one laser, in order, while the actuator moves or not
/// @return       nothing where there are no four scans in which ten beams, and a quarter of them, met
/// something
std::optional<double> largest_jump(const std::vector<SeriesScan>& scans);

}  // namespace crisp
