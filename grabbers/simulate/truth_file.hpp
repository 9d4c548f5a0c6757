// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include <crisp/calibration.hpp>

#include "grabbers/simulate/recording_settings.hpp"

namespace crisp::simulate {

/// The truth of a simulation as a calibration for assembly; its provenance holds, as text, the scene, seed
/// and settings, and the true clock of each device: `laser1.clock.skew` (hub seconds a device second − 1),
/// `.clock.start` [s], `.clock.drift` [1/s], `.minimum_delay` [s], `.stamp_lag` [s]. Effects of clocks,
/// links, mirrors and noise are there as `effect laser1.noise.heavy_tail.share`; effects that are terms are
/// in the calibration itself.
Calibration truth_to_write(const RecordingTruth& truth, const RecordingSettings& settings,
                           const std::string& scene);

/// Writes it; a file is there whole or not at all. @throws Error if it cannot be written
void write_truth(const std::filesystem::path& file, const RecordingTruth& truth,
                 const RecordingSettings& settings, const std::string& scene);

}  // namespace crisp::simulate
