// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/data/goodness_of_fit_tests.hpp"
#include "plugins/diagnose/scans/scan_prediction_errors.hpp"

namespace crisp::diagnose {

/// Tests the times of a sweep's scans by the score of their lags. A wrong time shifts a scan's ranges from
/// their prediction by slope times lag. Two patterns of lags are tested, both independent of the ranges:
/// `delays`, and alternately late and early scans. The statistic is the sum of scores over all scans. Its
/// null distribution comes from 4999 random signs per block of scans (sign-flip test), for the larger of both
/// patterns. Blocks are four scans with two between them, so they hardly share ranges. The test assumes no
/// distribution of noise or scene; a corner that all beams pass at once is one block of many.
///
/// @param scores  at the tested times
/// @param delays  [s] of each scan of the series, up to sign and a constant
/// @return empty with too few blocks for the test
std::optional<data::FitStatistics> sweep_fit_test(const std::vector<SeriesScan>& scans,
                                                  const std::vector<ScanScore>& scores,
                                                  const std::vector<double>& delays, std::uint64_t seed);

}  // namespace crisp::diagnose
