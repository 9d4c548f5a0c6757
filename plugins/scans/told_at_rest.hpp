// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/data/likeness.hpp"
#include "plugins/scans/alternation.hpp"

namespace crisp {

/// Whether scans at rest can be told from simulated ones, which are all alike but for their noise: by how
/// much more scans some counts apart differ than others (LagContrast). In random order those of a plain
/// simulation differ as much: a permutation test.
///
/// With kinds whose beams point elsewhere the same is asked once that is taken out. In the first half of each
/// rest the shifts are found again, and the profile of the kind that the others are compared with; from the
/// scans of the second half what this foretells is taken: for a kind that is shifted, ranges between two
/// beams of the profile, straight from the one spot to the other. So only beams count around which that
/// profile is straight. The worse of two answers counts: 499 simulations of such an interleave, each fitted
/// anew, with the noise of the measured scans in another order and of either sign, say how much chance leaves
/// between the kinds; and each kind's scans in random order, whether these are alike. Before and after are
/// then of the same scans and beams.
///
/// @param scans     at rest, in the order in which they were taken
/// @param is_moved  of each kind, whether it was found to point elsewhere
/// @return nothing where too few beams or scans are left to ask
std::optional<ToldApart> told_at_rest(const std::string& laser, const std::vector<SeriesScan>& scans,
                                      const Alternation& alternation, const std::vector<bool>& is_moved,
                                      std::uint64_t seed);

}  // namespace crisp
