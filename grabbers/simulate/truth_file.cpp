// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/truth_file.hpp"

#include <fmt/format.h>

#include <crisp/calibration_file.hpp>

#include "grabbers/simulate/device_effects.hpp"

namespace crisp::simulate {
namespace {

void add_device(std::map<std::string, std::string>& provenance, const DeviceTruth& device) {
  const auto add = [&](const char* what, double value) {
    provenance[device.name + "." + what] = fmt::format("{}", value);
  };
  add("clock.start", device.clock.start);
  add("clock.skew", device.clock.skew);
  add("clock.drift", device.clock.drift);
  add("minimum_delay", device.minimum_delay);
  add("stamp_lag", device.stamp_lag);
  for (std::size_t i = 0; i < device.clock.resets.size(); ++i) {
    add(fmt::format("clock.reset{}", i + 1).c_str(), device.clock.resets[i]);
  }
}

}  // namespace

Calibration truth_to_write(const RecordingTruth& truth, const RecordingSettings& settings,
                           const std::string& scene) {
  Calibration result = truth.calibration;
  auto& provenance = result.provenance;
  provenance["origin"] = "the truth of a simulation";
  provenance["scene"] = scene;
  provenance["seed"] = fmt::format("{}", settings.scanner.seed);
  provenance["duration"] = fmt::format("{} s", settings.scanner.duration);
  provenance["range.sigma"] = fmt::format("{} m", settings.scanner.range.sigma);
  provenance["hub.epoch_ns"] = fmt::format("{}", settings.start_ns);
  for (const auto& laser : truth.lasers) add_device(provenance, laser);
  add_device(provenance, truth.plate);
  for_each_device_effect(settings, [&](const std::string& name, double value) {
    provenance["effect " + name] = fmt::format("{}", value);
  });
  return result;
}

void write_truth(const std::filesystem::path& file, const RecordingTruth& truth,
                 const RecordingSettings& settings, const std::string& scene) {
  write_calibration(file, truth_to_write(truth, settings, scene));
}

}  // namespace crisp::simulate
