// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "pipeline/estimate/sample.hpp"

namespace crisp::estimate {

/// After which angle of the plate, by its encoder, a laser sees the same again.
struct SceneRepeat {
  double angle = 0;   ///< [rad] 2π if the encoder's counts a revolution are right
  double miss = 0;    ///< [m] by how much ranges differ after that angle, in the mean over all up to 0.5 m
  double at_2pi = 0;  ///< [m] and after 2π
  double close_at_2pi = 0;  ///< [m] the same of beams within 0.01 rad of that; 0 where there are few
  double elsewhere = 0;     ///< [m] and after angles at which a scene does not repeat
};

/// Compares the ranges of the same beam of the same laser after one turn and another, without any
/// calibration: for periods within 8 % of 2π, and of its half, third and quarter and as many times as much.
///
/// @return nothing where the plate turned by less than a turn and a fifth, or where too few beams can be
///         compared, as at an even rate of the plate
std::optional<SceneRepeat> scene_repeat(const Sample& sample);

/// Whether that shows that the counts a revolution are wrong.
bool contradicts_counts(const SceneRepeat& period);

/// The caveat then, with advice.
std::string counts_caveat(const SceneRepeat& period);

}  // namespace crisp::estimate
