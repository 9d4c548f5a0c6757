// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

#include <crisp/cloud.hpp>
#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>

namespace crisp::test {

/// n points with awkward numbers in every field: long fractions, tiny, huge, the largest index.
inline Cloud sample_cloud(std::size_t n) {
  Cloud cloud;
  cloud.header.stamp = 1'700'000'000'123'456;
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<float>(i);
    Point point;
    point.x = 1.0F / (k + 3);
    point.y = -1e-30F * k;
    point.z = 16777217.0F + k * 1e5F;
    point.intensity = k * 0.1F;
    point.laser = static_cast<std::uint16_t>(i % 3 == 2 ? 65535 : i % 3);
    point.beam = static_cast<std::uint16_t>(i % 541);
    point.time = 1e9 / 3 + static_cast<double>(i) * 1.234567890123e-5;
    cloud.push_back(point);
  }
  return cloud;
}

inline Measurements sample_measurements(std::size_t n) {
  Measurements beams;
  beams.epoch_ns = 1'700'000'000'123'456'789;
  for (std::size_t i = 0; i < n; ++i) {
    beams.range.push_back(1.0F + 0.001F * static_cast<float>(i));
    beams.mirror_angle.push_back(-0.785398F + 0.0087F * static_cast<float>(i % 541));
    beams.time.push_back(0.1 + static_cast<double>(i) * 18.5e-6);
    beams.laser.push_back(static_cast<std::uint16_t>(i % 3));
    beams.remission.push_back(static_cast<float>(i % 255));
    beams.beam.push_back(static_cast<std::uint16_t>(i % 541));
  }
  return beams;
}

/// A plate that speeds up, read every millisecond from 0 to `seconds`.
inline PlateTrajectory sample_plate(double seconds) {
  std::vector<double> times;
  std::vector<double> angles;
  for (int i = 0; i * 1e-3 <= seconds; ++i) {
    times.push_back(i * 1e-3);
    angles.push_back(1.0 / 3 + 6.0 * times.back() * times.back());
  }
  return {1'700'000'000'123'456'789, std::move(times), std::move(angles), 0.02};
}

}  // namespace crisp::test
