// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grabbers/bag/point_cloud.hpp"
#include "grabbers/bag/ros_scan_messages.hpp"

namespace crisp::bag {

/// Role of a topic's messages in the rig.
struct BagRoute {
  std::vector<std::uint16_t> lasers;  ///< whose scans they are, or hold; several are rings of one 3D laser
  std::optional<ScanDecoder> scans;
  std::optional<PointDecoder> points;  ///< of the lasers, in their place
  bool is_head = false;                ///< whether the azimuth of these points is the plate's angle
  std::optional<AngleDecoder> angles;  ///< of the plate
};

/// Tests whether a rig states clearly which topic each laser's scans have.
/// @throws Errors  all that is missing or contradicts itself
void check_topics(const Rig& rig);

/// Finds of which device of the rig a bag's topics are: by the rig's names, or by the type where the rig
/// names none and only one topic is of such a type.
class BagRoutes {
 public:
  explicit BagRoutes(Rig rig) : rig_(std::move(rig)) {}

  /// @throws Error if two topics could be of one device, or the topic that the rig names holds none of its
  /// kind
  BagRoute route(const BagConnection& connection);

  /// Topics that the rig names and no connection had so far.
  std::vector<std::string> missing() const;

 private:
  std::vector<std::uint16_t> lasers_of(const BagConnection& connection) const;
  void route_scans(const BagConnection& connection, BagRoute& route);
  void route_angles(const BagConnection& connection, BagRoute& route);
  static void take(std::optional<std::string>& by, const BagConnection& connection, const std::string& device,
                   const char* key);

  Rig rig_;
  std::set<std::string> seen_;
  std::optional<std::string> guessed_laser_;  ///< the topic that was taken for the only laser's
  std::optional<std::string> guessed_plate_;
};

}  // namespace crisp::bag
