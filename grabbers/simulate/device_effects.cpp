// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/device_effects.hpp"

#include <algorithm>

#include <crisp/error.hpp>

namespace crisp::simulate {
namespace {

/// Target of an effect's parameter: a laser's settings, or those of any device.
struct Row {
  std::string effect;
  std::string parameter;
  double& (*of_laser)(LaserEffects&) = nullptr;
  double& (*of_device)(DeviceEffects&) = nullptr;
};

const std::vector<Row>& rows() {
  using L = LaserEffects;
  using D = DeviceEffects;
  static const std::vector<Row> kRows = {
      {"noise.normal", "sigma", [](L& l) -> double& { return l.noise.sigma; }},
      {"noise.range_dependent", "slope", [](L& l) -> double& { return l.noise.slope; }},
      {"noise.incidence_dependent", "spread", [](L& l) -> double& { return l.noise.spread; }},
      {"noise.remission_dependent", "jitter", [](L& l) -> double& { return l.noise.jitter; }},
      {"noise.heavy_tail", "share", [](L& l) -> double& { return l.noise.tail_share; }},
      {"noise.heavy_tail", "scale", [](L& l) -> double& { return l.noise.tail_scale; }},
      {"noise.mixed_pixels", "divergence", [](L& l) -> double& { return l.noise.divergence; }},
      {"noise.mixed_pixels", "aperture", [](L& l) -> double& { return l.noise.aperture; }},
      {"noise.mixed_pixels", "merge", [](L& l) -> double& { return l.noise.merge; }},
      {"noise.two_peaks", "separation", [](L& l) -> double& { return l.noise.separation; }},
      {"noise.two_peaks", "least", [](L& l) -> double& { return l.noise.least_weight; }},
      {"noise.two_peaks", "most", [](L& l) -> double& { return l.noise.most_weight; }},
      {"noise.quantisation", "step", [](L& l) -> double& { return l.noise.step; }},
      {"mirror.period", "excess", [](L& l) -> double& { return l.mirror_excess; }},
      {"mirror.wander", "rms", [](L& l) -> double& { return l.mirror_wander; }},
      {"mirror.interleave", "shift", [](L& l) -> double& { return l.interleave.shift; }},
      {"mirror.interleave", "period", [](L& l) -> double& { return l.interleave.period; }},
      {"mirror.interleave", "kind", [](L& l) -> double& { return l.interleave.kind; }},
      {"clock.drift", "skew", nullptr, [](D& d) -> double& { return d.skew; }},
      {"clock.drift", "drift", nullptr, [](D& d) -> double& { return d.drift; }},
      {"clock.step", "by", nullptr, [](D& d) -> double& { return d.clock.by; }},
      {"clock.step", "at", nullptr, [](D& d) -> double& { return d.clock.at; }},
      {"latency.step", "by", nullptr, [](D& d) -> double& { return d.latency.by; }},
      {"latency.step", "at", nullptr, [](D& d) -> double& { return d.latency.at; }},
      {"latency.jitter", "mean", nullptr, [](D& d) -> double& { return d.jitter; }},
      {"latency.jitter", "shape", nullptr, [](D& d) -> double& { return d.shape; }},
      {"latency.bursts", "together", nullptr, [](D& d) -> double& { return d.bursts.together; }},
      {"latency.bursts", "interval", nullptr, [](D& d) -> double& { return d.bursts.interval; }},
      {"latency.bursts", "wait", nullptr, [](D& d) -> double& { return d.bursts.wait; }},
  };
  return kRows;
}

const Row* find_row(const std::string& effect, const std::string& parameter) {
  const auto found = std::ranges::find_if(
      rows(), [&](const Row& row) { return row.effect == effect && row.parameter == parameter; });
  return found == rows().end() ? nullptr : &*found;
}

bool affects_devices(const std::string& effect) {
  return std::ranges::any_of(rows(), [&](const Row& row) { return row.effect == effect; });
}

bool affects_clocks(const std::string& effect) {
  return std::ranges::any_of(rows(), [&](const Row& row) { return row.effect == effect && row.of_device; });
}

bool affects(const Effect& effect, std::size_t device) { return !effect.owner || *effect.owner == device; }

void set(const Row& row, std::size_t device, double value, RecordingSettings& settings) {
  if (row.of_device) {
    row.of_device(settings.device_effects[device]) = value;
  } else if (device < settings.scanner.laser_effects.size()) {
    row.of_laser(settings.scanner.laser_effects[device]) = value;
  }
}

void draw_nothing_else(const Effect& measured, std::size_t device, RecordingSettings& settings) {
  if (measured.name == "clock.drift") settings.device_effects[device].drawn = false;
  if (measured.name == "mirror.period") settings.scanner.laser_effects[device].mirror_drawn = false;
}

}  // namespace

std::vector<EffectInfo> recording_catalogue(const TermRegistry& terms) {
  std::vector<EffectInfo> catalogue = effect_catalogue(terms);
  for (auto& info : catalogue) {
    if (affects_clocks(info.name)) info.scope = Scope::kDevice;
  }
  return catalogue;
}

std::vector<EffectInfo> laser_catalogue(const TermRegistry& terms) {
  std::vector<EffectInfo> catalogue = effect_catalogue(terms);
  std::erase_if(catalogue, [](const EffectInfo& info) {
    return !affects_devices(info.name) || affects_clocks(info.name);
  });
  return catalogue;
}

std::vector<Effect> apply_device_effects(std::vector<Effect> effects, RecordingSettings& settings) {
  const std::size_t lasers = settings.scanner.rig.lasers.size();
  settings.scanner.laser_effects.resize(lasers);
  settings.device_effects.resize(lasers + 1);
  for (const auto& effect : effects) {
    for (const auto& [parameter, value] : effect.values) {
      const Row* row = find_row(effect.name, parameter);
      for (std::size_t device = 0; row && device <= lasers; ++device) {
        if (!affects(effect, device)) continue;
        set(*row, device, value, settings);
        if (effect.measured) draw_nothing_else(effect, device, settings);
      }
    }
  }
  std::erase_if(effects, [](const Effect& effect) { return affects_devices(effect.name); });
  return effects;
}

void for_each_device_effect(const RecordingSettings& settings,
                            const std::function<void(const std::string& name, double value)>& visit) {
  const auto& rig = settings.scanner.rig;
  for (std::size_t device = 0; device <= rig.lasers.size(); ++device) {
    const bool plate = device == rig.lasers.size();
    LaserEffects laser = plate ? LaserEffects{} : settings.scanner.effects_of(device);
    LaserEffects plain_laser;
    DeviceEffects other = settings.device_effects.empty() ? DeviceEffects{} : settings.device_effects[device];
    DeviceEffects plain_device;
    for (const auto& row : rows()) {
      const double value = row.of_device ? row.of_device(other) : row.of_laser(laser);
      const double plain = row.of_device ? row.of_device(plain_device) : row.of_laser(plain_laser);
      if (value == plain) continue;
      visit((plate ? rig.plate.name : rig.lasers[device].name) + "." + row.effect + "." + row.parameter,
            value);
    }
  }
}

}  // namespace crisp::simulate
