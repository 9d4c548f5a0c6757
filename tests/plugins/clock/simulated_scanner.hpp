// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <crisp/scan.hpp>

#include "pipeline/data/degree.hpp"
#include "tests/support/simulated_stamps.hpp"

namespace crisp::test {

/// A device's clock: what it shows at a true time [s].
struct SimulatedClock {
  double start = 1000;                                              ///< [s] at true time 0
  std::function<double(double)> skew = [](double) { return 0.0; };  ///< at a true time
  double reset_at = HUGE_VAL;                                       ///< [s] true time at which it begins anew
  double step_at = HUGE_VAL;                                        ///< [s] true time at which it jumps
  double step_by = 0;                                               ///< [s] forwards

  /// Shown times at a series of ascending true times: the integral of the skew, in small steps.
  class Reader {
   public:
    explicit Reader(const SimulatedClock& clock) : clock_(&clock), shown_(clock.start) {}
    std::uint32_t microseconds(double t) {
      if (t >= clock_->reset_at && time_ < clock_->reset_at) {
        time_ = clock_->reset_at;
        shown_ = 0;
      }
      shown_ += (t - time_) / (1 + clock_->skew(0.5 * (t + time_)));
      time_ = t;
      const double stepped = t >= clock_->step_at ? clock_->step_by : 0;
      return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(1e6 * (shown_ + stepped))));
    }

   private:
    const SimulatedClock* clock_;
    double time_ = 0;
    double shown_;
  };
};

inline constexpr std::int64_t kStart_ns = 1'700'000'000'250'000'000;  ///< hub time at true time 0
inline constexpr double kStart = 0.25;                                ///< [s] of it after the epoch

inline std::int64_t receipt_ns(double t) { return kStart_ns + std::llround(1e9 * t); }

struct SimulatedLaser {
  SimulatedClock clock;
  Delays delays = exponential_delays(1e-4);
  double minimum_delay = 1e-3;  ///< [s]
  std::function<double(double)> period = [](double) {
    return 0.0201145;
  };                                                  ///< [s] of the mirror, at a true time
  Delays stamp_jitter = [](Random&) { return 0.0; };  ///< [s] of the scans' stamps
  double first_turn = 0.003;                          ///< [s] true time
  int stamped_turns_late = 0;                         ///< by so many turns is a stamp late
  std::size_t beams = 541;
  std::function<bool(double)> is_lost = [](double) { return false; };  ///< of a scan that begins then

  struct Turn {
    Scan scan;
    double begin = 0;   ///< [s] true time of the beam at −45°
    double period = 0;  ///< [s]
  };
  std::vector<Turn> turns(std::uint64_t seed, std::uint16_t index, double duration) const {
    Random random(seed * 100 + index);
    SimulatedClock::Reader stamps(clock);
    SimulatedClock::Reader transmissions(clock);
    std::vector<Turn> all;
    double last_receipt = 0;
    auto counter = static_cast<std::uint16_t>(random());
    for (double t = first_turn; t < duration;) {
      Turn turn{.scan = {}, .begin = t, .period = period(t)};
      const double sent = t + turn.period + 3.1e-3;
      const double stamp = t + stamped_turns_late * turn.period + stamp_jitter(random);
      last_receipt = std::max(last_receipt, sent + minimum_delay + delays(random));
      Scan& scan = turn.scan;
      scan.laser = index;
      scan.telegram_counter = scan.scan_counter = ++counter;
      scan.scan_time_us = stamps.microseconds(stamp);
      scan.transmission_time_us = transmissions.microseconds(sent);
      scan.receipt_ns = receipt_ns(last_receipt);
      scan.scan_frequency = 50;
      scan.start_angle = -45 * data::kDegree;
      scan.angle_step = 270 * data::kDegree / static_cast<double>(beams - 1);
      scan.echoes.resize(1);
      scan.echoes[0].ranges.assign(beams, 2.0F);
      t += turn.period;
      if (!is_lost(turn.begin)) all.push_back(std::move(turn));
    }
    return all;
  }
};

struct SimulatedPlate {
  SimulatedClock clock;
  Delays delays = exponential_delays(5e-5);
  double minimum_delay = 5e-4;  ///< [s]
  std::function<double(double)> angle = [](double t) { return 2 * std::numbers::pi * t; };
  std::uint32_t first_count = 0xFFFFFF00;  ///< so that it wraps soon
  bool forgets_count_at_reset = false;
  std::function<bool(double)> is_lost = [](double) { return false; };

  std::vector<PlateReading> readings(std::uint64_t seed, double duration) const {
    Random random(seed * 100 + 99);
    SimulatedClock::Reader times(clock);
    std::vector<PlateReading> all;
    double last_receipt = 0;
    auto sequence = static_cast<std::uint16_t>(random());
    for (int i = 0; i * 0.002 < duration; ++i) {
      const double t = i * 0.002;
      const bool anew = forgets_count_at_reset && t >= clock.reset_at;
      const double turned = angle(t) - (anew ? angle(clock.reset_at) : 0);
      PlateReading reading;
      reading.sequence = ++sequence;
      reading.device_us = times.microseconds(t);
      reading.count = (anew ? 0 : first_count) +
                      static_cast<std::uint32_t>(std::llround(turned * 16384 / (2 * std::numbers::pi)));
      last_receipt = std::max(last_receipt, t + minimum_delay + delays(random));
      reading.receipt_ns = receipt_ns(last_receipt);
      if (!is_lost(t)) all.push_back(reading);
    }
    return all;
  }
};

}  // namespace crisp::test
