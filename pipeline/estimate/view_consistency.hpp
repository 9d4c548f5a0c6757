// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/quality/surfels.hpp"

namespace crisp {

/// Whether lasers meet the same surfaces at the same places: what tells a calibration from one that ended
/// elsewhere, where each laser has crisp surfaces of its own.
struct Agreement {
  /// For each laser (or, if there is but one, its front and its back) the share of its beams on surfaces that
  /// lie on such as another one meets within 3 σ of the ranges' noise. Negative for one without beams there.
  std::vector<double> shares;
  bool by_halves = false;  ///< whether `shares` are of the one laser's front and back
};

/// @param beams   whose view is 2 · laser, and one more for the back half of its sweep
/// @param lasers  how many
/// @param noise   [m] standard deviation of a range
Agreement agreement(const Surfels& surfels, const BeamsView& beams, std::size_t lasers, double noise);

/// For each laser with less than half of its beams in agreement a sentence that says so.
std::vector<std::string> disagreements(const Agreement& agreement, const std::vector<std::string>& lasers);

}  // namespace crisp
