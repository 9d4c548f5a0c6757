// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <crisp/findings.hpp>
#include <crisp/plate_trajectory.hpp>

#include "plugins/diagnose/scans/scan_series.hpp"

namespace crisp::diagnose {

/// Prediction errors of scans from their neighbours [m].
struct ScanPredictionErrors {
  std::vector<std::size_t> scan;            ///< index in the series
  std::vector<std::vector<double>> errors;  ///< [m] per beam

  double median() const;
};

/// Predicts each scan of a sweep from the scans before and after, and returns the prediction errors. Ranges
/// are interpolated linearly over the actuator's angle in the beam's direction. The only assumption about the
/// scene is that surfaces slope: no plane is fitted, and no mounting parameter is involved.
///
/// Beams are selected by ranges alone, from two scans on either side at the same index. The ranges differ
/// by 0.1 to 0.6 m (so that the angle matters), and the beam lies within 0.2 m of their mean (no edge).
///
/// @param scans   of one laser
/// @param times   [s] of the scans; the sweep is where `plate` moves then
/// @param angles  [rad] declared angle of each scan's first beam
ScanPredictionErrors scan_prediction_errors(const std::vector<SeriesScan>& scans,
                                            const std::vector<double>& times,
                                            const std::vector<double>& angles, const PlateTrajectory& plate);

/// Score of one scan for its lag relative to its neighbours.
struct ScanScore {
  std::size_t scan = 0;  ///< index in the series
  double score = 0;      ///< [m²] Σ of prediction error times slope
  double squares = 0;    ///< [m²] Σ of squared slopes
  double beams = 0;
  std::array<double, 5> weights{};  ///< of the scans from two before to two after in the prediction error
};

/// Scores of the beams selected by scan_prediction_errors(), predicted from two neighbours on either side, so
/// that surfaces of constant curvature have score 0. The slope of a range is that between the second
/// neighbours.
std::vector<ScanScore> scan_scores(const std::vector<SeriesScan>& scans, const std::vector<double>& times,
                                   const std::vector<double>& angles, const PlateTrajectory& plate);

/// Change of the median prediction error over the scans common to both. The interval is a block bootstrap
/// over five scans.
Gain prediction_gain(const ScanPredictionErrors& before, const ScanPredictionErrors& after,
                     std::uint64_t seed);

}  // namespace crisp::diagnose
