// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_routes.hpp"

#include <fmt/format.h>

#include <crisp/error.hpp>

namespace crisp {

std::optional<std::uint16_t> BagRoutes::laser_of(const BagConnection& connection) const {
  for (std::size_t i = 0; i < rig_.lasers.size(); ++i) {
    const std::string& topic = rig_.lasers[i].topic;
    if (topic == connection.topic || (topic.empty() && rig_.lasers.size() == 1))
      return static_cast<std::uint16_t>(i);
  }
  return std::nullopt;
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

BagRoute BagRoutes::route(const BagConnection& connection) {
  seen_.insert(connection.topic);
  BagRoute route;
  if (const auto laser = laser_of(connection)) {
    const RigLaser& of = rig_.lasers[*laser];
    route.scans = ScanDecoder::of(connection);
    if (!of.topic.empty()) route.points = PointDecoder::of(connection);
    if (route.scans || route.points) route.laser = laser;
    if (route.scans && of.topic.empty()) take(guessed_laser_, connection, of.name, of.name.c_str());
    if (!route.laser && !of.topic.empty()) {
      throw Error(fmt::format("messages of {}, the topic of {}, are {}, which is no type of scans", of.topic,
                              of.name, connection.type),
                  "scans are sensor_msgs/LaserScan, MultiEchoLaserScan or PointCloud2");
    }
  }
  const RigPlate& plate = rig_.plate;
  const bool is_joint_state = connection.type == "sensor_msgs/JointState";
  if (plate.topic.empty() ? is_joint_state && plate.field.empty() : plate.topic == connection.topic) {
    route.angles = AngleDecoder::of(connection, plate);
    if (route.angles && plate.topic.empty()) take(guessed_plate_, connection, plate.name, "plate");
  }
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

}  // namespace crisp
