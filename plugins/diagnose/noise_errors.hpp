// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/data/calibration.hpp"
#include "plugins/diagnose/noise_law.hpp"
#include "plugins/diagnose/noise_ways.hpp"

namespace crisp {

/// A law, fitted until nothing moves any more, and how it comes out without one part of its ranges after
/// another (jackknife).
struct LawInParts {
  struct Without {
    double share = 0;  ///< of all ranges, that is left out
    NoiseLaw law;
  };

  NoiseLaw law;
  RangeErrors errors;           ///< that it was fitted to
  std::vector<Without> times;   ///< parts that are strewn over the blocks of the recording
  std::vector<Without> places;  ///< likewise over the places that were met; empty where none are known
};

/// @param law  as it was found
LawInParts in_parts(const NoiseLaw& law, const RangeErrors& errors);

/// The parameters of one of the ways that a law has, within the bounds that the catalogue gives them, so that
/// they can be simulated. Values are less what the fit is off in the mean: a mean and a weight of each beam's
/// own, told from some hundred ranges, pull at all that beams share. Standard errors are those over the times
/// or over the places, whichever are larger: where a surface is no plane, it is none at every turn.
std::vector<Parameter> parameters_of(const NoiseWay& way, const LawInParts& fits);

}  // namespace crisp
