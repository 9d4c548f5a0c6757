// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/point_cones.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::bag {
namespace {

constexpr double kTolerance = 0.01;            // [rad] of an elevation: half a degree
constexpr std::uint64_t kEnoughPoints = 1000;  // to refuse a recording before its end

/// [rad] Median elevation of a ring's points; nothing without any.
std::optional<double> elevation_of(const PointMessage& message, int ring) {
  std::vector<double> elevations;
  for (const CloudPoint& point : message.points) {
    if (point.ring == ring) elevations.push_back(point.elevation);
  }
  if (elevations.empty()) return {};
  return statistics::median_in_place(elevations);
}

}  // namespace

std::vector<LaserPoint> PointCones::select(const PointMessage& message, std::span<const std::uint16_t> lasers,
                                           bool on_head) {
  std::map<int, std::uint16_t> of_ring;
  for (const std::uint16_t laser : lasers) {
    const auto& ring = rig_.lasers[laser].ring;
    if (ring) of_ring[*ring] = laser;
    Cone& cone = cones_[laser];
    cone.on_head = on_head;
    if (!cone.elevation) cone.elevation = on_head && ring ? elevation_of(message, *ring) : std::optional(0.0);
  }
  std::vector<LaserPoint> selected;
  for (const CloudPoint& point : message.points) {
    const auto found = of_ring.find(point.ring);
    if (!of_ring.empty() && found == of_ring.end()) {
      ++losses_["points of rings that the rig does not name"];
      continue;
    }
    const std::uint16_t laser = of_ring.empty() ? lasers.front() : found->second;
    if (accept(laser, point)) selected.push_back({laser, point});
  }
  for (const std::uint16_t laser : lasers) {
    if (cones_[laser].on + cones_[laser].off >= kEnoughPoints) check(laser);
  }
  return selected;
}

bool PointCones::accept(std::uint16_t laser, const CloudPoint& point) {
  Cone& cone = cones_[laser];
  if (std::abs(point.elevation - *cone.elevation) <= kTolerance) {
    ++cone.on;
    return true;
  }
  ++cone.off;
  ++losses_[cone.on_head ? "points off the cone of their ring" : "points outside of the scan plane z = 0"];
  return false;
}

void PointCones::check(std::uint16_t laser) const {
  const Cone& cone = cones_[laser];
  if (cone.off <= cone.on) return;
  const RigLaser& of = rig_.lasers[laser];
  if (cone.on_head) {
    throw Error(fmt::format("{} of {} points of ring {} on {} are off its cone of {:.1f} degrees", cone.off,
                            cone.on + cone.off, *of.ring, of.topic, *cone.elevation * 180 / std::numbers::pi),
                "record the laser's points in its own frame, where a ring has one elevation");
  }
  throw Error(
      fmt::format("{} of {} points of {} on {} are outside of the plane z = 0: they are of a 3D laser",
                  cone.off, cone.on + cone.off, of.name, of.topic),
      "name its rings as lasers (ring: 0) and give the plate the same topic, if its head is all that turns; of a 3D laser on a plate name a ring within half a degree of the plane, if it has one");
}

void PointCones::check() const {
  for (std::size_t i = 0; i < cones_.size(); ++i) check(static_cast<std::uint16_t>(i));
}

}  // namespace crisp::bag
