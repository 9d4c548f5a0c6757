// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "grabbers/simulate/effects.hpp"
#include "grabbers/simulate/recording_settings.hpp"

namespace crisp::simulate {

/// The catalogue's effects that can be simulated in a recording: with telegrams, a clock's drift is a
/// device's own, and so also the plate's. The scene's effects are in it, to be rejected with advice.
std::vector<EffectInfo> recording_catalogue(const TermRegistry& terms);

/// The catalogue's effects of a laser's noise and mirror, which are simulated without telegrams.
std::vector<EffectInfo> laser_catalogue(const TermRegistry& terms);

/// Applies effects of devices (clocks, links, mirrors, noise) to the settings. Effects of the true
/// calibration, which are terms, are left.
///
/// @return the others
std::vector<Effect> apply_device_effects(std::vector<Effect> effects, RecordingSettings& settings);

/// Calls visit("laser1.noise.heavy_tail.share", value in SI) for each value of such effects that is not the
/// one that changes nothing.
void for_each_device_effect(const RecordingSettings& settings,
                            const std::function<void(const std::string& name, double value)>& visit);

}  // namespace crisp::simulate
