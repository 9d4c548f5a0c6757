// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <crisp/rig.hpp>

#include "grabbers/bag/point_cloud.hpp"

namespace crisp::bag {

/// A point of a cloud with the laser that measured it.
struct LaserPoint {
  std::uint16_t laser = 0;  ///< index in the rig
  CloudPoint point;
};

/// Finds which points of a cloud a laser measured, by their ring and elevation: those of a 2D laser lie in
/// the plane z = 0, those of a laser of a rotating head on a cone of constant elevation.
class PointCones {
 public:
  explicit PointCones(const Rig& rig) : rig_(rig), cones_(rig.lasers.size()) {}

  /// The points of these lasers in their order; points off a laser's cone are left out and counted.
  /// @param on_head  whether the lasers turn with a head; else each sweeps its plane by itself
  /// @throws Error if most points of a laser are off its cone
  std::vector<LaserPoint> select(const PointMessage& message, std::span<const std::uint16_t> lasers,
                                 bool on_head);
  /// @throws Error if most points of a laser are off its cone, however few there are
  void check() const;

  const std::map<std::string, std::uint64_t>& losses() const { return losses_; }

 private:
  struct Cone {
    std::optional<double> elevation;  ///< [rad] nothing: of no point so far
    bool on_head = false;
    std::uint64_t on = 0, off = 0;  ///< points
  };
  bool accept(std::uint16_t laser, const CloudPoint& point);
  void check(std::uint16_t laser) const;

  Rig rig_;
  std::vector<Cone> cones_;
  std::map<std::string, std::uint64_t> losses_;
};

}  // namespace crisp::bag
