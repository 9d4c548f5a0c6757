// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/effect_injection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "grabbers/simulate/device_effects.hpp"

namespace crisp::simulate {
namespace {

/// A scan does not contain incidences, nor the surfaces that a wider spot would have met.
constexpr auto kPossible = std::to_array<std::string_view>(
    {"clock.drift", "clock.step", "latency.step", "mirror.period", "noise.heavy_tail", "noise.normal",
     "noise.quantisation", "noise.range_dependent", "noise.remission_dependent", "noise.two_peaks",
     "range.step"});

void set_range_step(const Effect& effect, InjectedEffects& of) {
  for (const auto& [parameter, value] : effect.values) {
    if (parameter == "h") of.range.by = -value;  // h is what must be added to get at the truth
    if (parameter == "at") of.range.at = value;
  }
}

}  // namespace

std::vector<EffectInfo> injectable_effects(const TermRegistry& terms) {
  std::vector<EffectInfo> catalogue = recording_catalogue(terms);
  std::erase_if(catalogue, [](const EffectInfo& info) {
    return std::ranges::find(kPossible, info.name) == std::ranges::end(kPossible);
  });
  return catalogue;
}

std::vector<InjectedEffects> injected_effects(const std::vector<Effect>& effects, const Rig& rig) {
  RecordingSettings settings{.scanner = {.rig = rig}};
  const auto range_steps = apply_device_effects(effects, settings);
  std::vector<InjectedEffects> all;
  for (std::size_t laser = 0; laser < rig.lasers.size(); ++laser) {
    InjectedEffects& mine = all.emplace_back(InjectedEffects{.laser = settings.scanner.effects_of(laser),
                                                             .device = settings.device_effects[laser]});
    for (const Effect& effect : range_steps) {
      if (effect.owner.value_or(laser) == laser) set_range_step(effect, mine);
    }
  }
  return all;
}

EffectInjector::EffectInjector(const InjectedEffects& effects, std::uint64_t seed, std::string name)
    : effects_(effects), seed_(seed), name_(std::move(name)) {}

Scan EffectInjector::changed(const Scan& scan) {
  if (!noise_) {
    noise_.emplace(RangeSettings{.sigma = 0, .quantum = 0}, effects_.laser.noise, seed_, name_);
    last_us_ = scan.scan_time_us;
    first_ns_ = scan.receipt_ns;
  }
  elapsed_us_ += static_cast<std::int32_t>(scan.scan_time_us - last_us_);  // it wraps
  last_us_ = scan.scan_time_us;
  Scan other = scan;
  change_ranges(other);
  change_times(other);
  return other;
}

void EffectInjector::change_times(Scan& scan) {
  const double elapsed = 1e-6 * static_cast<double>(elapsed_us_);
  const double turns = std::round(elapsed * scan.scan_frequency);
  const double later = turns * effects_.laser.mirror_excess;  // than the scan was taken
  const DeviceClock clock{
      .skew = effects_.device.skew, .drift = effects_.device.drift, .step = effects_.device.clock};
  const double shift = clock.seconds(elapsed + later) - elapsed;
  const auto shift_us = static_cast<std::uint32_t>(std::llround(1e6 * shift));  // modulo 2^32, as its clock
  scan.scan_time_us += shift_us;
  scan.transmission_time_us += shift_us;
  const double received = 1e-9 * static_cast<double>(scan.receipt_ns - first_ns_) + later;
  scan.receipt_ns += std::llround(1e9 * (later + effects_.device.latency.before(received)));
}

void EffectInjector::change_ranges(Scan& scan) {
  const double received = 1e-9 * static_cast<double>(scan.receipt_ns - first_ns_);
  const double jump = effects_.range.before(received);
  for (Echo& echo : scan.echoes) {
    for (std::size_t beam = 0; beam < echo.ranges.size(); ++beam) {
      const auto draw = noise_->draw(static_cast<std::uint16_t>(beam));
      float& range = echo.ranges[beam];
      if (range <= 0) continue;  // a code, no range
      const double remission = beam < echo.remissions.size() ? echo.remissions[beam] : 0;
      const double noisy = noise_->reported({.range = range + jump, .remission = remission}, draw);
      range = static_cast<float>(std::max(noisy, 1e-3));  // stays a range
    }
  }
}

}  // namespace crisp::simulate
