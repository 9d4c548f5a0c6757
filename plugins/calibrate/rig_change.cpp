// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/mirror_angle.hpp"

namespace crisp::calibrate {
namespace {

using data::kDegree;

constexpr double kHalfTurn = std::numbers::pi;
constexpr std::array kTurns = {180 * kDegree, 90 * kDegree, -90 * kDegree, 45 * kDegree, -45 * kDegree};

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

std::size_t different_changes(const RigChange& change) {
  std::vector<LaserChange> different;
  for (const LaserChange& laser : change.lasers) {
    const bool is_known = std::ranges::find(different, laser) != different.end();
    if (laser != LaserChange{} && !is_known) different.push_back(laser);
  }
  return different.size();
}

/// Whether lasers change, and each of these by half a turn or upside down.
bool is_half_turn(const RigChange& change) {
  const auto is_half = [](const LaserChange& laser) {
    return laser == LaserChange{} || laser.is_upside_down || laser.mount_turn == kTurns.front();
  };
  return different_changes(change) > 0 && std::ranges::all_of(change.lasers, is_half);
}

/// Both changes, of different lasers.
RigChange both(RigChange one, const RigChange& other) {
  one.words += (one.words.empty() ? "" : ", ") + other.words;
  for (std::size_t laser = 0; laser < one.lasers.size(); ++laser) {
    if (other.lasers[laser] != LaserChange{}) one.lasers[laser] = other.lasers[laser];
  }
  return one;
}

}  // namespace

RigChange no_change(const Rig& rig) {
  return {.words = {}, .lasers = std::vector<LaserChange>(rig.lasers.size())};
}

std::string mount_in_words(const RigLaser& laser, double mount) {
  const double shown = std::remainder(mount, 2 * kHalfTurn) / kDegree;
  return fmt::format("mount: {:.4g}deg of {} (the rig has {:.4g})", shown, laser.name, laser.mount / kDegree);
}

RigChange other_direction(const Rig& rig) {
  const bool is_clockwise = rig.plate.direction == CountDirection::clockwise;
  RigChange change = no_change(rig);
  change.words = fmt::format("plate.direction: {}", is_clockwise ? "counter_clockwise" : "clockwise");
  change.turn = -1;
  return change;
}

std::vector<RigChange> changes_of_laser(const Rig& rig, std::size_t laser) {
  const RigLaser& own = rig.lasers[laser];
  const double alpha = own.nominal.alpha.value;
  RigChange upside_down = no_change(rig);
  upside_down.words =
      fmt::format("alpha: {:.4g}deg of {}, which is upside down (the rig has {:.4g})",
                  std::remainder(alpha + kHalfTurn, 2 * kHalfTurn) / kDegree, own.name, alpha / kDegree);
  upside_down.lasers[laser].is_upside_down = true;
  std::vector<RigChange> all = {std::move(upside_down)};
  for (const double turn : kTurns) {
    RigChange change = no_change(rig);
    change.words = mount_in_words(own, own.mount + turn);
    change.lasers[laser].mount_turn = turn;
    all.push_back(std::move(change));
  }
  return all;
}

std::vector<RigChange> other_mounts(const Rig& rig) {
  std::vector<RigChange> all;
  for (const double turn : kTurns) {
    RigChange change = no_change(rig);
    change.words = mount_in_words(rig.lasers[0], rig.lasers[0].mount + turn);
    if (rig.lasers.size() > 1) change.words += " and the mounts of the others turned alike";
    for (LaserChange& laser : change.lasers) laser.mount_turn = turn;
    all.push_back(std::move(change));
  }
  return all;
}

std::vector<RigChange> exchanges(const Rig& rig) {
  const auto is_one_device = [](const RigLaser& a, const RigLaser& b) {  // the beams of a 3D laser
    return a.address == b.address && a.topic == b.topic;
  };
  std::vector<RigChange> all;
  for (std::size_t j = 1; j < rig.lasers.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      if (is_one_device(rig.lasers[i], rig.lasers[j])) continue;
      RigChange change = no_change(rig);
      change.words =
          fmt::format("the addresses of {} and {} exchanged", rig.lasers[i].name, rig.lasers[j].name);
      change.exchanged = {i, j};
      change.lasers[i].mount_turn = rig.lasers[i].mount - rig.lasers[j].mount;
      change.lasers[j].mount_turn = -change.lasers[i].mount_turn;
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

std::vector<RigChange> combinations(const std::vector<std::vector<RigChange>>& of_lasers, std::size_t most) {
  std::vector<RigChange> all;
  for (const auto& alternatives : of_lasers) {
    std::vector<RigChange> longer;
    for (const RigChange& change : alternatives) {
      if (all.empty()) longer.push_back(change);
      for (const RigChange& before : all) longer.push_back(both(before, change));
    }
    std::ranges::stable_sort(longer, {}, different_changes);
    if (longer.size() > most) longer.resize(most);  // further lasers make no combination simpler
    all = std::move(longer);
  }
  return all;
}

bool are_alike(const RigChange& one, const RigChange& other) {
  return (one.exchanged && other.exchanged) || (is_half_turn(one) && is_half_turn(other));
}

ChangedSample::ChangedSample(const estimate::Sample& sample, const RigChange& change)
    : sample_(sample), plate_(turned_by(*sample.plate, change.turn)) {
  for (std::size_t i = 0; i < sample_.beams.size(); ++i) {
    auto& laser = sample_.beams.laser[i];
    laser = laser_after(change, laser);
    const LaserChange& own = change.lasers[laser];
    float& angle = sample_.beams.mirror_angle[i];
    angle = static_cast<float>(data::wrapped_mirror_angle(angle - own.mount_turn));
    if (own.is_upside_down) angle = -angle;
  }
  sample_.plate = &plate_;
}

}  // namespace crisp::calibrate
