// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/data/goodness_of_fit_tests.hpp"
#include "plugins/diagnose/scans/interleave.hpp"

namespace crisp::diagnose {

/// Goodness-of-fit test of stationary scans against the model of identical scans with independent noise: a
/// permutation test of the contrast between lags (LagContrast).
///
/// With scan classes of shifted beams, it also tests the model that corrects the shifts. The first half of
/// each stationary phase gives the shifts and the reference profile. The prediction for the second half
/// interpolates the profile linearly in space, so only beams count around which the profile is straight. The
/// p-value is the smaller of two tests, corrected. A parametric bootstrap tests the differences between
/// classes, by 499 refitted simulations with permuted and sign-flipped noise of the measured scans. A
/// permutation test within each class tests its scans. Statistics before and after then refer to the same
/// scans and beams.
///
/// @param scans     of the stationary laser, in order
/// @param is_moved  per scan class: whether its shift was accepted
/// @return empty with too few beams or scans for the test
std::optional<data::GoodnessOfFit> stationary_fit_test(const std::string& laser,
                                                       const std::vector<SeriesScan>& scans,
                                                       const ScanInterleave& interleave,
                                                       const std::vector<bool>& is_moved, std::uint64_t seed);

}  // namespace crisp::diagnose
