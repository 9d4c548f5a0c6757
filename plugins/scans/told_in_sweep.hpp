// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/data/likeness.hpp"
#include "plugins/scans/neighbours.hpp"

namespace crisp {

/// Whether the scans of a sweep were taken when they are said to be. Scans that were taken at other times
/// have ranges beyond those that their neighbours foretell, by the slope of each times the scan's lag behind
/// its neighbours. That is looked for along two courses of the lags, which no range has entered: that of
/// `delays`, and later and earlier by turns. Of each course the pulls of all scans are added. If nothing
/// lags, a stretch of scans pulls as likely the one way as the other: in 4999 draws of signs for the
/// stretches chance pulls as much, along either course, as often as the p-value says. (Stretches are four
/// scans with two between them, that share no range but what hardly counts.) Neither the noise nor the scene
/// is assumed to be of any law; a corner that all beams pass at once is one stretch of many.
///
/// @param pulls   by the times that are asked
/// @param delays  [s] of each scan of the series, up to a sign and a constant
/// @return nothing where there are too few stretches to ask
std::optional<Likeness> told_in_sweep(const std::vector<SeriesScan>& scans,
                                      const std::vector<ScanPull>& pulls, const std::vector<double>& delays,
                                      std::uint64_t seed);

}  // namespace crisp
