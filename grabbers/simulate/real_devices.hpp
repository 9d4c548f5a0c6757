// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "grabbers/simulate/effects.hpp"

namespace crisp::simulate {

/// Names of the real devices whose habits come with crisp: those of configs/devices, when it was built.
const std::vector<std::string>& real_devices();

/// The habits of real devices as effects, each of one laser or of the plate, measured ones.
///
/// @param wanted     "lms111" (every laser is such a one), "laser2=tim781s", "plate=esp32_wifi"; what comes
///                   later is in place of what came before of the same laser
/// @param catalogue  what can be simulated; other habits are left out
/// @throws Error or Errors  for devices that are not known, owners that the rig does not have, and owners
///                          that cannot have such habits
std::vector<Effect> effects_of_real_devices(const std::vector<std::string>& requested, const Rig& rig,
                                            const std::vector<EffectInfo>& catalogue);

}  // namespace crisp::simulate
