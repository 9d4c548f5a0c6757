// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include "tests/independent/world.hpp"

namespace independent {

/// Adds solids of random size and place that leave the scanner free.
class SceneBuilder {
 public:
  SceneBuilder(double height, std::mt19937_64 random) : scanner_{0, 0, height}, random_(random) {}

  double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  int count(int low, int high) { return std::uniform_int_distribution<>(low, high)(random_); }
  bool chance(double probability) { return between(0, 1) < probability; }
  double sign() { return chance(0.5) ? 1 : -1; }

  /// The space that encloses the scanner, or the ground: added whatever its clearance.
  void shell(Vector center, Vector size) {
    world_.add({Form::box, center, {}, 0.5 * size, between(0.3, 0.9)});
  }
  bool add(Form form, Vector center, Axes axes, Vector half) {
    const Solid solid{form, center, axes, half, between(0.1, 0.95)};
    if (clearance(solid, scanner_) < kKeepOut) return false;
    world_.add(solid);
    return true;
  }
  bool box(Vector bottom, double yaw, Vector size) {
    return add(Form::box, bottom + Vector{0, 0, size.z / 2}, turned_about_vertical(yaw), 0.5 * size);
  }
  bool post(Vector bottom, double radius, double height) {
    return add(Form::cylinder, bottom + Vector{0, 0, height / 2}, {}, {radius, radius, height / 2});
  }
  bool ball(Vector center, Vector half) { return add(Form::ellipsoid, center, {}, half); }
  /// A cylinder that lies along a horizontal direction.
  bool pipe(Vector center, double yaw, double radius, double length) {
    const Vector along{std::cos(yaw), std::sin(yaw), 0}, up{0, 0, 1};
    return add(Form::cylinder, center, {cross(up, along), up, along}, {radius, radius, length / 2});
  }
  void table(Vector at, double yaw, double length, double depth, double height) {
    if (!box(at + Vector{0, 0, height - 0.03}, yaw, {length, depth, 0.03})) return;
    const Axes axes = turned_about_vertical(yaw);
    for (const double u : {-0.46, 0.46}) {
      for (const double v : {-0.44, 0.44})
        post(at + (u * length) * axes.x + (v * depth) * axes.y, 0.025, height - 0.03);
    }
  }
  void chair(Vector at, double yaw) {
    if (!box(at + Vector{0, 0, 0.43}, yaw, {0.45, 0.45, 0.06})) return;
    const Axes axes = turned_about_vertical(yaw);
    box(at - 0.2 * axes.y + Vector{0, 0, 0.5}, yaw, {0.42, 0.05, 0.5});
    post(at, 0.03, 0.43);
  }
  World world() { return world_; }

 private:
  /// Free space about the scanner [m]: its lasers stand up to 0.55 m off the axis.
  static constexpr double kKeepOut = 0.85;

  Vector scanner_;
  std::mt19937_64 random_;
  World world_;
};

}  // namespace independent
