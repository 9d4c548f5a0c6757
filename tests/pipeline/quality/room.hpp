// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "pipeline/quality/surfels.hpp"
#include "tests/pipeline/quality/clouds.hpp"

namespace crisp::test {

inline const Eigen::Vector3d kRoomLow(-4.1, -3.03, -1.2);
inline const Eigen::Vector3d kRoomHigh(3.97, 2.81, 1.75);

/// Beams from a spinning scanner in a box room, with what they were made of.
struct RoomScan {
  Vectors points, directions;
  std::vector<std::uint32_t> views;
  std::vector<std::uint32_t> laser;
  std::vector<Eigen::Vector3d> outwards;  ///< from the spin axis to the laser, at the time of each beam

  quality::BeamsView beams() const { return {points.view(), directions.view(), views}; }
};

/// @param shifts  [m] of each laser from where its beams are thought to start: outwards and along its motion
/// @param noise   [m] of the ranges
inline RoomScan scan_room(std::size_t beams_a_laser, const std::vector<Eigen::Vector2d>& shifts, double noise,
                          unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> error(0, noise);
  RoomScan scan;
  for (std::uint32_t laser = 0; laser < shifts.size(); ++laser) {
    for (std::size_t k = 0; k < beams_a_laser; ++k) {
      const double t = 10.0 * static_cast<double>(k) / static_cast<double>(beams_a_laser);
      const double plate = 2 * M_PI * (laser / 3.0 + t + 0.3 * std::sin(0.6 * t));
      const double mirror = M_PI * (-0.75 + 1.5 * std::fmod(50 * t + 0.13 * laser, 1.0));
      const Eigen::Vector3d out(std::cos(plate), std::sin(plate), 0);
      const Eigen::Vector3d along(-out.y(), out.x(), 0);
      const Eigen::Vector3d direction =
          std::sin(mirror) * along - std::cos(mirror) * Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d start = (0.2 + shifts[laser][0]) * out + shifts[laser][1] * along;
      double range = 1e9;
      for (int axis = 0; axis < 3; ++axis) {
        const double wall = direction[axis] > 0 ? kRoomHigh[axis] : kRoomLow[axis];
        if (direction[axis] != 0) range = std::min(range, (wall - start[axis]) / direction[axis]);
      }
      const Eigen::Vector3d point = 0.2 * out + (range + error(random)) * direction;
      add(scan.points, point.x(), point.y(), point.z());
      add(scan.directions, direction.x(), direction.y(), direction.z());
      scan.laser.push_back(laser);
      scan.views.push_back(2 * laser + (mirror > 0 ? 1 : 0));
      scan.outwards.push_back(out);
    }
  }
  return scan;
}

}  // namespace crisp::test
