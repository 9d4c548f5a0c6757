// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/data/plate_trajectory.hpp"
#include "plugins/scans/scan_series.hpp"

namespace crisp {

/// Of each scan that counts, how far its ranges lie from what its two neighbours foretell [m].
struct NeighbourErrors {
  std::vector<std::size_t> scan;            ///< index in the series
  std::vector<std::vector<double>> errors;  ///< [m] its beams'

  double median() const;
};

/// How well each scan of a sweep is foretold by the scans before and after it: their ranges in the beam's
/// direction, straight from the one to the other over the actuator's angle. It asks nothing of the scene but
/// that surfaces slope: no plane is fitted and no parameter of the mounting enters.
///
/// Which beams count is decided by ranges alone, two scans to either side, at the same index: these differ by
/// 0.1 to 0.6 m (so that the angle matters), and the beam lies within 0.2 m of their mean (no edge).
///
/// @param scans   of one laser
/// @param times   [s] when each was taken; the sweep is where `plate` moves then
/// @param angles  [rad] reported angle of each scan's first beam
NeighbourErrors neighbour_errors(const std::vector<SeriesScan>& scans, const std::vector<double>& times,
                                 const std::vector<double>& angles, const PlateTrajectory& plate);

/// What the ranges of one scan say of its time, beside those of its neighbours.
struct ScanPull {
  std::size_t scan = 0;  ///< index in the series
  double pull = 0;       ///< [m²] Σ of what its ranges are beyond those foretold, times their slopes
  double squares = 0;    ///< [m²] Σ of the slopes' squares
  double beams = 0;
  std::array<double, 5> weights{};  ///< of scans from two before to two after in what its ranges are beyond
};

/// The same beams as for neighbour_errors, but from two neighbours to either side, so that surfaces which
/// bend evenly pull nowhere. The slope of a range is that between the second neighbours.
std::vector<ScanPull> scan_pulls(const std::vector<SeriesScan>& scans, const std::vector<double>& times,
                                 const std::vector<double>& angles, const PlateTrajectory& plate);

/// What the change brought for the scans that both count: medians, and the interval of their difference by a
/// bootstrap over blocks of five scans.
Gain neighbour_gain(const NeighbourErrors& before, const NeighbourErrors& after, std::uint64_t seed);

}  // namespace crisp
