// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/mirror_rotation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

namespace crisp::simulate {

Mirror::Mirror(const MirrorSettings& settings, std::uint64_t seed, const std::string& laser, double excess)
    : settings_(settings), jitter_(seed, laser + ".mirror.jitter") {
  if (!(settings.frequency > 0)) {
    throw Error(fmt::format("the mirror of {} turns at {:g} Hz", laser, settings.frequency),
                "give a mirror_frequency above 0 Hz");
  }
  if (!(std::abs(settings.slowest) < 0.5 && std::abs(excess * settings.frequency) < 0.5 &&
        settings.wander >= 0 && settings.wander < 0.5 && settings.jitter >= 0 && settings.jitter < 0.05)) {
    throw Error("the period of the mirror of " + laser + " deviates by half of its nominal value or more",
                "reduce mirror_slowest, mirror_wander, mirror_jitter or the effect mirror.period");
  }
  constexpr double kTurn = 2 * std::numbers::pi;
  statistics::RandomStream random(seed, laser + ".mirror");
  time_ = random.uniform() / settings.frequency;
  slowness_ = random.uniform(0, settings.slowest);
  if (excess != 0) slowness_ = excess * settings.frequency;
  for (auto& wave : waves_) {
    wave = {.amplitude = settings.wander / static_cast<double>(waves_.size()),
            .angular_frequency = kTurn * random.uniform(0.1, 0.6),
            .phase = random.uniform(0, kTurn)};
  }
}

// Each wave has its part of the largest departure, and 1/√2 of that as its root mean square.
double Mirror::wander_of_rms(double rms) { return rms * std::sqrt(2.0 * kWaves); }

Revolution Mirror::next() {
  double departure = slowness_;
  for (const auto& wave : waves_) {
    departure += wave.amplitude * std::sin(wave.angular_frequency * time_ + wave.phase);
  }
  if (settings_.jitter > 0) departure += settings_.jitter * jitter_.normal();
  const Revolution revolution{
      .number = number_++, .begin = time_, .period = (1 + departure) / settings_.frequency};
  time_ += revolution.period;
  return revolution;
}

}  // namespace crisp::simulate
