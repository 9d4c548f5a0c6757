// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/findings.hpp>

#include "grabbers/simulate/effects.hpp"

namespace crisp::simulate {

/// Findings of a diagnosis that can be simulated.
struct FoundEffects {
  std::vector<Effect> effects;      ///< of one owner each; later ones go before earlier ones
  std::vector<std::string> others;  ///< the rest, by name, with the reason, for people
};

/// Converts findings to effects: each device's clock (`clock.drift`), delays (`latency.jitter`, Weibull) and
/// noise (`noise.normal`), then the accepted findings in their order, then the mirrors' periods
/// (`mirror.period`) and how they wander (`mirror.wander`).
///
/// @param file       their origin, for messages
/// @param catalogue  effects that can be simulated; a finding without one is among the others
/// @throws Error or Errors  for devices that the rig does not have, parameters that the effect does not have,
///                          and values in a wrong unit or beyond the bounds
FoundEffects effects_of(const Findings& findings, const std::string& file, const Rig& rig,
                        const std::vector<EffectInfo>& catalogue);

}  // namespace crisp::simulate
