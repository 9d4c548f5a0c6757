// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>

#include "pipeline/data/degree.hpp"
#include "plugins/diagnose/scans/scan_series.hpp"

namespace crisp::test {

/// A laser on a tilt axis in a room with floor, wavy wall and ceiling, by formulas independent of the code
/// under test. Tilt 0 points down, 90° ahead; the fan spreads along the axis.
class TiltingScene {
 public:
  explicit TiltingScene(double noise, std::uint64_t seed = 1) : noise_(noise), random_(seed) {}

  /// [m] Noise-free range.
  static double range(double tilt, double fan) {
    const double away = std::sin(fan), along = -std::cos(fan);  // of the axis, per metre of beam
    double best = 30;
    const auto nearer = [&](double r) {
      if (r > 0 && r < best) best = r;
    };
    nearer(1.2 / (away * std::cos(tilt)));   // the floor
    nearer(-1.5 / (away * std::cos(tilt)));  // the ceiling
    double r = 3 / (away * std::sin(tilt));  // the wall, with waves of 4 cm across
    for (int i = 0; i < 8 && r > 0; ++i) r = (3 + 0.04 * std::sin(6 * r * along)) / (away * std::sin(tilt));
    nearer(r);
    return best;
  }

  /// A scan of `beams` beams at one-degree spacing from `first` on, each at its own tilt.
  std::shared_ptr<Scan> scan(double tilt, double first, std::size_t beams, std::uint16_t count,
                             double receipt) {
    auto scan = std::make_shared<Scan>();
    scan->scan_counter = count;
    scan->scan_time_us = scan->transmission_time_us =
        static_cast<std::uint32_t>(std::lround(count * kPeriod * 1e6));
    scan->receipt_ns = std::llround(receipt * 1e9);
    scan->start_angle = 20 * data::kDegree;
    scan->angle_step = data::kDegree;
    scan->echoes.resize(1);
    for (std::size_t k = 0; k < beams; ++k) {
      const double r = range(tilt, first + static_cast<double>(k) * data::kDegree);
      scan->echoes[0].ranges.push_back(static_cast<float>(r + noise_ * normal_(random_)));
    }
    return scan;
  }

  static constexpr double kPeriod = 0.0133;  // [s]

 private:
  double noise_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

inline PlateReading reading_at(double angle, double time, double counts_per_revolution = 360000) {
  return {
      .device_us = static_cast<std::uint32_t>(std::lround(time * 1e6)),
      .count = static_cast<std::uint32_t>(std::lround(angle / (360 * data::kDegree) * counts_per_revolution)),
      .receipt_ns = std::llround(time * 1e9)};
}

}  // namespace crisp::test
