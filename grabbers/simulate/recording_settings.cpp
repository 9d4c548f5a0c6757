// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/recording_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <crisp/error.hpp>

#include "pipeline/files/nearest.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {
namespace {

constexpr double kWrap = 4294.967296;  // [s] of a 32-bit counter of microseconds

DeviceTruth draw_device(const RecordingSettings& settings, std::size_t index, const std::string& name) {
  const bool is_laser = index < settings.scanner.rig.lasers.size();
  DeviceTruth device{.name = name, .link = is_laser ? settings.laser_link : settings.plate_link};
  if (!settings.clock_overrides.empty()) {
    device.clock = settings.clock_overrides[index];
  } else {
    statistics::RandomStream random(settings.scanner.seed, name + ".clock");
    device.clock.start = random.uniform(0, kWrap);
    device.clock.skew = random.uniform(-settings.clocks.skew, settings.clocks.skew);
    device.clock.drift = random.uniform(-settings.clocks.drift, settings.clocks.drift);
  }
  if (!settings.device_effects.empty()) {
    const DeviceEffects& effects = settings.device_effects[index];
    if (!effects.drawn) device.clock.skew = device.clock.drift = 0;
    device.clock.skew += effects.skew;
    device.clock.drift += effects.drift;
    device.clock.step = effects.clock;
    device.latency = effects.latency;
    if (effects.jitter > 0) device.link.jitter = effects.jitter;
    device.link.shape *= effects.shape;
    if (effects.bursts.together > 0) device.link = with_bursts(device.link, effects.bursts);
  }
  for (const auto& restart : settings.faults.restarts) {
    if (restart.device == name) device.clock.resets.push_back(restart.time);
  }
  std::sort(device.clock.resets.begin(), device.clock.resets.end());
  return device;
}

void check_names(const RecordingSettings& settings) {
  const auto& rig = settings.scanner.rig;
  std::vector<std::string> names;
  for (const RigLaser& laser : rig.lasers) names.push_back(laser.name);
  names.push_back(rig.plate.name);
  const auto check = [&](const std::string& name) {
    if (std::ranges::find(names, name) != names.end()) return;
    throw Error("a fault is set for the device '" + name + "', which the rig does not have",
                files::did_you_mean(name, names, fmt::format("it has {}", fmt::join(names, ", "))));
  };
  for (const auto& silence : settings.faults.silences) check(silence.device);
  for (const auto& restart : settings.faults.restarts) check(restart.device);
}

void check(const RecordingSettings& settings) {
  const std::size_t lasers = settings.scanner.rig.lasers.size();
  if (settings.scanner.truth.lasers.size() != lasers) {
    throw Error(fmt::format("the simulation's truth has {} lasers, but the rig has {}",
                            settings.scanner.truth.lasers.size(), lasers),
                "give the truth of each laser of the rig, in its order");
  }
  if (!settings.clock_overrides.empty() && settings.clock_overrides.size() != lasers + 1) {
    throw Error(fmt::format("the simulation has {} clocks for {} lasers and the plate",
                            settings.clock_overrides.size(), lasers),
                "give one clock a laser and one for the plate, or none at all");
  }
  if (!settings.stamp_lags.empty() && settings.stamp_lags.size() != lasers) {
    throw Error(fmt::format("there are {} stamp_lags for {} lasers", settings.stamp_lags.size(), lasers),
                "give one a laser, or none at all");
  }
  const auto& effects = settings.device_effects;
  if (!effects.empty() && effects.size() != lasers + 1) {
    throw Error(fmt::format("the simulation has effects of {} devices for {} lasers and the plate",
                            effects.size(), lasers),
                "give those of each laser and of the plate, or none at all");
  }
  check_names(settings);
}

}  // namespace

bool FaultSettings::silent(const std::string& device, double time) const {
  return std::any_of(silences.begin(), silences.end(), [&](const Silence& silence) {
    return silence.device == device && time >= silence.begin && time < silence.begin + silence.duration;
  });
}

RecordingTruth draw_devices(const RecordingSettings& settings) {
  check(settings);
  const auto& rig = settings.scanner.rig;
  RecordingTruth truth{.calibration = settings.scanner.truth};
  truth.plate = draw_device(settings, rig.lasers.size(), rig.plate.name);
  truth.plate.minimum_delay = settings.plate_link.minimum;
  for (std::size_t i = 0; i < rig.lasers.size(); ++i) {
    DeviceTruth& laser = truth.lasers.emplace_back(draw_device(settings, i, rig.lasers[i].name));
    if (!settings.stamp_lags.empty()) laser.stamp_lag = settings.stamp_lags[i];
    const double eta = truth.calibration.lasers[i].eta.value;
    truth.plate.minimum_delay =
        std::max(truth.plate.minimum_delay, settings.laser_link.minimum + laser.stamp_lag + eta);
  }
  for (std::size_t i = 0; i < rig.lasers.size(); ++i) {
    DeviceTruth& laser = truth.lasers[i];
    laser.minimum_delay = truth.plate.minimum_delay - laser.stamp_lag - truth.calibration.lasers[i].eta.value;
  }
  return truth;
}

}  // namespace crisp::simulate
