// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <numeric>

#include <crisp/clock_aligner.hpp>

#include "tests/plugins/clock/simulated_scanner.hpp"

namespace crisp::test {

/// What an aligner made of a recording.
struct Aligned {
  struct Stretch {
    PlateTrajectory plate;
    std::vector<Measurements> scans;
  };
  std::vector<Stretch> stretches;
  AlignmentReport report;

  std::vector<const Measurements*> of_laser(std::uint16_t laser) const {
    std::vector<const Measurements*> found;
    for (const auto& stretch : stretches) {
      for (const auto& scan : stretch.scans) {
        if (scan.laser.front() == laser) found.push_back(&scan);
      }
    }
    return found;
  }
};

using Turns = std::vector<SimulatedLaser::Turn>;

/// Keeps what an aligner hands out.
inline AlignmentSink sink_into(Aligned& out) {
  return {
      .trajectory =
          [&](PlateTrajectory p) {
            out.stretches.push_back({std::move(p), {}});
          },
      .measurements =
          [&](const std::shared_ptr<const Measurements>& m) { out.stretches.back().scans.push_back(*m); }};
}

/// Feeds all telegrams to an aligner in the order of their receipt.
inline AlignmentReport feed(Aligner& aligner, const std::vector<Turns>& lasers,
                            const std::vector<PlateReading>& readings) {
  std::multimap<std::int64_t, std::function<void()>> arrivals;
  for (const auto& turns : lasers) {
    for (const auto& turn : turns) {
      arrivals.emplace(turn.scan.receipt_ns, [&] { aligner.add(std::make_shared<const Scan>(turn.scan)); });
    }
  }
  for (const auto& reading : readings) {
    arrivals.emplace(reading.receipt_ns, [&] { aligner.add(reading); });
  }
  for (const auto& [receipt, arrive] : arrivals) arrive();
  return aligner.finish();
}

inline Aligned align(const std::vector<Turns>& lasers, const std::vector<PlateReading>& readings,
                     const AlignmentSettings& settings = {}, Rig rig = default_rig()) {
  Aligned out;
  rig.lasers.resize(lasers.size());
  ClockAligner aligner(rig, settings, sink_into(out));
  out.report = feed(aligner, lasers, readings);
  return out;
}

inline Aligned align_online(const std::vector<Turns>& lasers, const std::vector<PlateReading>& readings,
                            const OnlineSettings& online = {}, Rig rig = default_rig()) {
  Aligned out;
  rig.lasers.resize(lasers.size());
  OnlineAligner aligner(rig, {.mirror_half_width = 5}, online, sink_into(out));
  out.report = feed(aligner, lasers, readings);
  return out;
}

struct TimeErrors {
  double median = 0;  ///< [s] of the absolute errors
  double worst = 0;   ///< [s]
};

/// How far the beams' hub times are from the true times plus the least delay of their laser.
inline TimeErrors beam_time_errors(const Aligned& aligned, std::uint16_t index, const SimulatedLaser& laser,
                                   const Turns& turns) {
  const auto scans = aligned.of_laser(index);
  EXPECT_EQ(scans.size(), turns.size());
  std::vector<double> errors;
  for (std::size_t i = 0; i < std::min(scans.size(), turns.size()); ++i) {
    for (const std::size_t k : {std::size_t{0}, scans[i]->size() - 1}) {
      const double fired = turns[i].begin + (k == 0 ? 0 : 0.75 * turns[i].period);
      errors.push_back(std::abs(scans[i]->time[k] - (kStart + fired + laser.minimum_delay)));
    }
  }
  if (errors.empty()) return {HUGE_VAL, HUGE_VAL};
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors.back()};
}

/// Three lasers with skews up to 250 ppm and mirrors up to 0.6 % slow that wander.
inline std::vector<SimulatedLaser> three_lasers(std::uint64_t seed) {
  Random random(seed);
  std::vector<SimulatedLaser> lasers(3);
  for (auto& laser : lasers) {
    const double skew = std::uniform_real_distribution<>(-250e-6, 250e-6)(random);
    const double slow = std::uniform_real_distribution<>(0, 6e-3)(random);
    laser.clock.start = std::uniform_real_distribution<>(0, 4294)(random);
    laser.clock.skew = [=](double) { return skew; };
    laser.period = [=](double t) { return 0.02 * (1 + slow + 2e-3 * std::sin(1.7 * t + 100 * slow)); };
    laser.beams = 9;
  }
  return lasers;
}

}  // namespace crisp::test
