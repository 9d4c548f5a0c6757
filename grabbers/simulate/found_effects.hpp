// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "grabbers/simulate/effects.hpp"
#include "pipeline/data/findings.hpp"

namespace crisp {

/// What a diagnosis found, as far as it can be simulated.
struct FoundEffects {
  std::vector<Effect> effects;      ///< of one owner each; later ones go before earlier ones
  std::vector<std::string> others;  ///< the rest, by name, with the reason, for people
};

/// What was measured of each device's clock (`clock.drift`), delays (`latency.jitter`, by Weibull's law) and
/// noise (`noise.normal`), then the accepted findings in their order, then the mirrors' periods
/// (`mirror.period`) and how they wander (`mirror.wander`).
///
/// @param file       where they are from, for messages
/// @param catalogue  what can be simulated; what is not in it is one of the others
/// @throws Error or Errors  for devices that the rig does not have, parameters that the effect does not have,
///                          and values in a wrong unit or beyond the bounds
FoundEffects effects_of(const Findings& findings, const std::string& file, const Rig& rig,
                        const std::vector<EffectInfo>& catalogue);

}  // namespace crisp
