// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "grabbers/simulate/effects.hpp"
#include "grabbers/simulate/recording_settings.hpp"

namespace crisp {

/// What of the catalogue can be simulated in a recording: where there are telegrams, a clock that drifts is a
/// device's own, and so also the plate's. What a scene does is in it, to be refused with a word.
std::vector<EffectInfo> recording_catalogue(const TermRegistry& terms);

/// Of the catalogue what befalls a laser's noise and mirror: what is simulated of a device without telegrams.
std::vector<EffectInfo> laser_catalogue(const TermRegistry& terms);

/// Puts the effects that befall devices (clocks, links, mirrors, noise) into the settings. Those of the true
/// calibration, which are terms, are left.
///
/// @return the others
std::vector<Effect> apply_device_effects(std::vector<Effect> effects, RecordingSettings& settings);

/// Calls visit("laser1.noise.heavy_tail.share", value in SI) for each value of such effects that is not the
/// one that changes nothing.
void for_each_device_effect(const RecordingSettings& settings,
                            const std::function<void(const std::string& name, double value)>& visit);

}  // namespace crisp
