// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <string>

#include "grabbers/bag/byte_cursor.hpp"

namespace crisp::bag {
namespace {

constexpr const char* kNoCloud = "point clouds that cannot be";

/// A field of the points.
struct Channel {
  std::size_t offset = 0;
  RosType type = RosType::float32;
};

/// The types of sensor_msgs/PointField by their numbers, from 1.
RosType type_of(std::int64_t number) {
  constexpr RosType kTypes[] = {RosType::int8,  RosType::uint8,  RosType::int16,   RosType::uint16,
                                RosType::int32, RosType::uint32, RosType::float32, RosType::float64};
  if (number < 1 || number > std::ssize(kTypes)) throw BagDamage{kNoCloud};
  return kTypes[number - 1];
}

/// A message's header and the bytes of its points.
struct Cloud2 {
  std::map<std::string, Channel, std::less<>> channels;
  std::int64_t sec = 0, nanosec = 0;
  std::size_t step = 0;  ///< [bytes] of a point
  bool is_big_endian = false;
  std::string_view data;

  const Channel* find(std::initializer_list<std::string_view> names) const {
    for (const auto name : names) {
      if (const auto found = channels.find(name); found != channels.end()) return &found->second;
    }
    return nullptr;
  }
  std::size_t points() const { return step == 0 ? 0 : data.size() / step; }
  double value(std::size_t point, const Channel& channel) const {
    return RosValue{.count = 1, .bytes = data.substr(point * step + channel.offset)}.number(channel.type);
  }
};

Cloud2 cloud_of(const RosMessageSchema& layout, const std::vector<RosValue>& values) {
  Cloud2 cloud;
  std::string name;
  Channel channel;
  for (const RosValue& value : values) {
    const RosField& field = layout.fields[value.field];
    const auto integer = [&] { return value.integer(field.type); };
    if (field.path == "header.stamp.sec") cloud.sec = integer() & 0xffffffff;
    if (field.path == "header.stamp.nanosec") cloud.nanosec = integer();
    if (field.path == "fields.name") name = value.bytes;
    if (field.path == "fields.offset") channel.offset = static_cast<std::size_t>(integer());
    if (field.path == "fields.datatype") {
      channel.type = type_of(integer());
      cloud.channels[name] = channel;
    }
    if (field.path == "is_bigendian") cloud.is_big_endian = integer() != 0;
    if (field.path == "point_step") cloud.step = static_cast<std::size_t>(integer());
    if (field.path == "data") cloud.data = value.bytes;
  }
  const auto fits = [&](const auto& entry) {
    return entry.second.offset + size_of(entry.second.type) <= cloud.step;
  };
  if (cloud.is_big_endian) throw BagDamage{"point clouds in big-endian numbers"};
  if (!std::ranges::all_of(cloud.channels, fits)) throw BagDamage{kNoCloud};
  return cloud;
}

/// [s] after the stamp.
double time_of(double value, RosType type, double stamp) {
  constexpr double kSince1970 = 1e8;  // [s] no scan lasts so long
  const bool is_whole = type != RosType::float32 && type != RosType::float64;
  const double seconds = is_whole ? 1e-9 * value : value;
  return seconds > kSince1970 ? seconds - stamp : seconds;
}

}  // namespace

std::optional<PointDecoder> PointDecoder::of(const BagConnection& connection) {
  auto layout = parse_ros_layout(connection.type, connection.definition);
  if (!layout || connection.type != "sensor_msgs/PointCloud2" || connection.encoding == RosEncoding::other)
    return std::nullopt;
  PointDecoder decoder;
  decoder.layout_ = std::move(*layout);
  decoder.encoding_ = connection.encoding;
  return decoder;
}

PointMessage PointDecoder::decode(std::string_view message) const {
  constexpr std::int64_t kSecondInNs = 1'000'000'000;
  const std::vector<RosValue> values = decode_ros(layout_, encoding_, message);
  const Cloud2 cloud = cloud_of(layout_, values);
  const Channel *x = cloud.find({"x"}), *y = cloud.find({"y"}), *z = cloud.find({"z"});
  if (x == nullptr || y == nullptr) throw BagDamage{"point clouds without x and y"};
  const Channel* time = cloud.find({"t", "time", "timestamp", "time_stamp", "offset_time"});
  const Channel* intensity = cloud.find({"intensity", "intensities", "i", "reflectivity"});
  const Channel* ring = cloud.find({"ring", "channel", "laser_id"});
  PointMessage result{.stamp_ns = kSecondInNs * cloud.sec + cloud.nanosec, .timed = time != nullptr};
  const double stamp = static_cast<double>(cloud.sec) + 1e-9 * static_cast<double>(cloud.nanosec);
  for (std::size_t k = 0; k < cloud.points(); ++k) {
    const double px = cloud.value(k, *x), py = cloud.value(k, *y);
    const double height = z == nullptr ? 0 : cloud.value(k, *z);
    const double across = std::hypot(px, py), range = std::hypot(across, height);
    if (!(range > 0) || !std::isfinite(range)) continue;
    result.points.push_back(
        {.range = static_cast<float>(range),
         .azimuth = std::atan2(py, px),
         .elevation = std::atan2(height, across),
         .time = time == nullptr ? 0 : time_of(cloud.value(k, *time), time->type, stamp),
         .remission = intensity == nullptr ? 0 : static_cast<float>(cloud.value(k, *intensity)),
         .ring = ring == nullptr ? -1 : static_cast<int>(cloud.value(k, *ring))});
  }
  std::ranges::stable_sort(result.points, {}, &CloudPoint::time);
  constexpr double kLongest = 100;  // [s]
  const bool is_long = std::ranges::any_of(
      result.points, [](const CloudPoint& point) { return !(std::abs(point.time) < kLongest); });
  if (is_long) throw BagDamage{"point clouds whose points are far from their stamp in time"};
  return result;
}

}  // namespace crisp::bag
