// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_change.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/mirror_angle.hpp"

namespace crisp {
namespace {

constexpr std::array kTurns = {180 * kDegree, 90 * kDegree, -90 * kDegree, 45 * kDegree, -45 * kDegree};

std::string mount_in_words(const RigLaser& laser, double turn) {
  const double mount = std::remainder(laser.mount + turn, 2 * std::numbers::pi);
  return fmt::format("mount: {:.4g}deg of {} (the rig has {:.4g})", mount / kDegree, laser.name,
                     laser.mount / kDegree);
}

PlateTrajectory turned_by(const PlateTrajectory& plate, double factor) {
  std::vector<double> angles;
  for (const double angle : plate.angles()) angles.push_back(factor * angle);
  return plate.with_angles(std::move(angles));
}

std::uint16_t laser_after(const RigChange& change, std::uint16_t laser) {
  if (!change.exchanged) return laser;
  const auto [one, other] = *change.exchanged;
  if (laser != one && laser != other) return laser;
  return static_cast<std::uint16_t>(one + other - laser);
}

}  // namespace

RigChange no_change(const Rig& rig) {
  return {.words = {}, .mount_turns = std::vector<double>(rig.lasers.size(), 0.0)};
}

std::vector<RigChange> other_mounts_of(const Rig& rig, std::size_t laser) {
  std::vector<RigChange> all;
  for (const double turn : kTurns) {
    RigChange change = no_change(rig);
    change.words = mount_in_words(rig.lasers[laser], turn);
    change.mount_turns[laser] = turn;
    all.push_back(std::move(change));
  }
  return all;
}

RigChange other_direction(const Rig& rig) {
  const bool is_clockwise = rig.plate.direction == CountDirection::clockwise;
  RigChange change = no_change(rig);
  change.words = fmt::format("plate.direction: {}", is_clockwise ? "counter_clockwise" : "clockwise");
  change.turn = -1;
  return change;
}

std::vector<RigChange> other_mounts(const Rig& rig) {
  std::vector<RigChange> all;
  for (const double turn : kTurns) {
    RigChange change{.words = mount_in_words(rig.lasers[0], turn),
                     .mount_turns = std::vector<double>(rig.lasers.size(), turn)};
    if (rig.lasers.size() > 1) change.words += " and the mounts of the others turned alike";
    all.push_back(std::move(change));
  }
  return all;
}

std::vector<RigChange> exchanges(const Rig& rig) {
  std::vector<RigChange> all;
  for (std::size_t j = 1; j < rig.lasers.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      RigChange change = no_change(rig);
      change.words =
          fmt::format("the addresses of {} and {} exchanged", rig.lasers[i].name, rig.lasers[j].name);
      change.exchanged = {i, j};
      change.mount_turns[i] = rig.lasers[i].mount - rig.lasers[j].mount;
      change.mount_turns[j] = -change.mount_turns[i];
      all.push_back(std::move(change));
    }
  }
  return all;
}

std::vector<RigChange> other_counts(const Rig& rig) {
  std::vector<RigChange> all;
  for (const double factor : {4.0, 0.25, 2.0, 0.5}) {
    RigChange change = no_change(rig);
    change.words = fmt::format("plate.counts_per_revolution: {:.10g} (the rig has {:.10g})",
                               rig.plate.counts_per_revolution / factor, rig.plate.counts_per_revolution);
    change.turn = factor;
    all.push_back(std::move(change));
  }
  return all;
}

ChangedSample::ChangedSample(const Sample& sample, const RigChange& change)
    : sample_(sample), plate_(turned_by(*sample.plate, change.turn)) {
  for (std::size_t i = 0; i < sample_.beams.size(); ++i) {
    auto& laser = sample_.beams.laser[i];
    laser = laser_after(change, laser);
    float& angle = sample_.beams.mirror_angle[i];
    angle = static_cast<float>(wrapped_mirror_angle(angle - change.mount_turns[laser]));
  }
  sample_.plate = &plate_;
}

}  // namespace crisp
