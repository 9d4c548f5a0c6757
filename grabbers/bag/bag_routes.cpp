// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_routes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

namespace crisp::bag {
namespace {

void check_topic(const RigLaser& laser, const Rig& rig) {
  if (!laser.topic.empty() || (rig.lasers.size() == 1 && !laser.ring)) return;
  throw Error(
      fmt::format("the rig gives no topic for the scans of {}", laser.name),
      fmt::format("name it in the rig: {}: {{topic: /scan, …}}; crisp info BAG lists topics", laser.name));
}

/// Each scan is of one laser.
void check_others(const RigLaser& laser, const Rig& rig) {
  for (const RigLaser& other : rig.lasers) {
    if (&other == &laser) return;
    if (other.topic.empty() || other.topic != laser.topic) continue;
    if (other.ring && laser.ring && other.ring != laser.ring) continue;
    throw Error(fmt::format("{} and {} have the same scans, of {}", other.name, laser.name, laser.topic),
                "give each a topic of its own, or in the points of a 3D laser a ring of its own");
  }
}

/// The reported angle of a ring on a rotating head is its elevation.
void check_mount(const RigLaser& laser, const Rig& rig) {
  constexpr double kRounding = 1e-3;  // [rad]
  const bool on_head = laser.ring && laser.topic == rig.plate.topic;
  if (!on_head || std::abs(laser.mount + std::numbers::pi / 2) <= kRounding) return;
  throw Error(
      fmt::format(
          "{} is a ring of a rotating head: its angle is its elevation, which is -90 degrees straight down",
          laser.name),
      fmt::format("write {}: {{mount: -90deg, …}} in the rig", laser.name));
}

}  // namespace

void check_topics(const Rig& rig) {
  AllErrors errors;
  for (const RigLaser& laser : rig.lasers) {
    errors.keep_of([&] { check_topic(laser, rig); });
    errors.keep_of([&] { check_others(laser, rig); });
    errors.keep_of([&] { check_mount(laser, rig); });
  }
  errors.throw_any();
}

std::vector<std::uint16_t> BagRoutes::lasers_of(const BagConnection& connection) const {
  std::vector<std::uint16_t> lasers;
  for (std::size_t i = 0; i < rig_.lasers.size(); ++i) {
    const std::string& topic = rig_.lasers[i].topic;
    if (topic == connection.topic || (topic.empty() && rig_.lasers.size() == 1))
      lasers.push_back(static_cast<std::uint16_t>(i));
  }
  return lasers;
}

/// Assigns a topic to a device whose topic the rig does not name.
void BagRoutes::take(std::optional<std::string>& by, const BagConnection& connection,
                     const std::string& device, const char* key) {
  if (by && *by != connection.topic) {
    throw Error(fmt::format("both {} and {} could be of {}", *by, connection.topic, device),
                fmt::format("name one of them in the rig: {}: {{topic: {}, …}}", key, *by));
  }
  by = connection.topic;
}

void BagRoutes::route_scans(const BagConnection& connection, BagRoute& route) {
  const auto lasers = lasers_of(connection);
  if (lasers.empty()) return;
  const RigLaser& of = rig_.lasers[lasers.front()];
  route.scans = ScanDecoder::of(connection);
  if (!of.topic.empty()) route.points = PointDecoder::of(connection);
  if (route.scans || route.points) {
    route.lasers = lasers;
    if (of.topic.empty()) take(guessed_laser_, connection, of.name, of.name.c_str());
  } else if (!of.topic.empty()) {
    throw Error(fmt::format("messages of {}, the topic of {}, are {}, which is no type of scans", of.topic,
                            of.name, connection.type),
                "scans are sensor_msgs/LaserScan, MultiEchoLaserScan or PointCloud2");
  }
}

void BagRoutes::route_angles(const BagConnection& connection, BagRoute& route) {
  const RigPlate& plate = rig_.plate;
  const bool is_joint_state = connection.type == "sensor_msgs/JointState";
  route.is_head = route.points && plate.topic == connection.topic;
  if (route.is_head) {
    const auto has_no_ring = [&](std::uint16_t laser) { return !rig_.lasers[laser].ring; };
    if (std::ranges::none_of(route.lasers, has_no_ring)) return;
    throw Error(fmt::format("{} is the topic of points and of {}, and the rig names no ring of them",
                            connection.topic, plate.name),
                "give each of the 3D laser's rings a laser: {topic: …, ring: 0, mount: -90deg, …}");
  }
  if (plate.topic.empty() ? is_joint_state && plate.field.empty() : plate.topic == connection.topic) {
    route.angles = AngleDecoder::of(connection, plate);
    if (route.angles && plate.topic.empty()) take(guessed_plate_, connection, plate.name, "plate");
  }
}

BagRoute BagRoutes::route(const BagConnection& connection) {
  seen_.insert(connection.topic);
  BagRoute route;
  route_scans(connection, route);
  route_angles(connection, route);
  return route;
}

std::vector<std::string> BagRoutes::missing() const {
  std::vector<std::string> topics;
  const auto note = [&](const std::string& topic) {
    if (!topic.empty() && !seen_.contains(topic)) topics.push_back(topic);
  };
  for (const auto& laser : rig_.lasers) note(laser.topic);
  note(rig_.plate.topic);
  return topics;
}

}  // namespace crisp::bag
