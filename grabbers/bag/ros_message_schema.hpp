// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grabbers/bag/bag_reader.hpp"

namespace crisp::bag {

/// Type of a message's field.
enum class RosType : std::uint8_t {
  boolean,
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  text,
  message
};

/// [bytes] that a number has; 0 for texts and messages.
std::size_t size_of(RosType type);

/// Number of a field's elements.
enum class RosCount : std::uint8_t { one, fixed, counted };

/// A field of a message, in a tree whose leaves are numbers and texts.
struct RosField {
  std::string path;  ///< "laserScan.header.stamp.sec"
  RosType type = RosType::message;
  std::string name;  ///< of the type of a message: "sensor_msgs/LaserScan"
  RosCount count = RosCount::one;
  std::uint32_t fixed = 1;         ///< of RosCount::fixed
  bool is_in_list = false;         ///< whether it, or a message that holds it, may come several times
  std::vector<std::size_t> parts;  ///< of a message: indices in RosMessageSchema::fields
};

/// The fields of a type of messages, as ROS' language of message definitions describes them. Field 0 is the
/// message itself. A time or duration is a message of sec and nanosec.
struct RosMessageSchema {
  std::vector<RosField> fields;

  /// The field of that path; nothing if there is none.
  std::optional<std::size_t> find(std::string_view path) const;
  /// The first message of that type, from the outside in; nothing if there is none.
  std::optional<std::size_t> find_type(std::string_view name) const;
  /// The stamp of the message's header, or of the first message within that has one; nothing without any.
  const RosField* stamp() const;
};

/// @param type        "sensor_msgs/LaserScan"
/// @param definition  of it and of all that it holds, each of these after a line of = and one of its name,
///                    "MSG: std_msgs/Header"; empty: of a type that is known here
/// @return nothing if the definition cannot be read, or is not there and the type not known
std::optional<RosMessageSchema> parse_ros_layout(const std::string& type, const std::string& definition);

/// Numbers or bytes of text in a message, which follow one another.
struct RosValue {
  std::size_t field = 0;  ///< index in RosMessageSchema::fields
  std::size_t count = 0;  ///< of numbers; of a text: 1
  std::string_view bytes;

  /// The i-th number, whatever its type is.
  double number(RosType type, std::size_t i = 0) const;
  std::int64_t integer(RosType type) const;
};

/// All values of a message in their order; fields of a message that comes several times come as often.
/// @throws BagDamage if the message does not match its type
std::vector<RosValue> decode_ros(const RosMessageSchema& layout, RosEncoding encoding,
                                 std::string_view message);

/// Definitions of the types that crisp uses, for bags without; empty for others.
/// @param type  "sensor_msgs/LaserScan"
std::string known_ros_definition(std::string_view type);

}  // namespace crisp::bag
