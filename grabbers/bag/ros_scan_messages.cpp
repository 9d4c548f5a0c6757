// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/ros_scan_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

#include "grabbers/bag/byte_cursor.hpp"
#include "pipeline/data/degree.hpp"

namespace crisp::bag {
namespace {

constexpr std::int64_t kSecondInNs = 1'000'000'000;
constexpr const char* kNoScan = "scans that cannot be";

bool is_number(const RosField& field) { return size_of(field.type) > 0 && !field.is_in_list; }

/// The field `name` below `prefix`, which is there in every message of its type.
std::size_t field_below(const RosMessageSchema& layout, const std::string& prefix, std::string_view name) {
  const auto found = layout.find(prefix.empty() ? std::string(name) : fmt::format("{}.{}", prefix, name));
  if (!found) throw BagDamage{kNoScan};
  return *found;
}

std::vector<float> floats_of(const RosValue& value) {
  std::vector<float> floats(value.count);
  if (!floats.empty()) std::memcpy(floats.data(), value.bytes.data(), value.count * sizeof(float));
  return floats;
}

/// The echoes of each beam as one list for each echo, in which beams without it have 0.
std::vector<std::vector<float>> by_echo(const std::vector<std::vector<float>>& beams) {
  std::size_t most = 0;
  for (const auto& beam : beams) most = std::max(most, beam.size());
  constexpr std::size_t kMaxEchoes = 64;
  if (most > kMaxEchoes) throw BagDamage{kNoScan};
  std::vector<std::vector<float>> echoes(most, std::vector<float>(beams.size()));
  for (std::size_t k = 0; k < beams.size(); ++k) {
    for (std::size_t e = 0; e < beams[k].size(); ++e) echoes[e][k] = beams[k][e];
  }
  return echoes;
}

/// Sets ranges outside of the message's own limits to 0, as in all scans.
void mark_no_echoes(std::vector<float>& ranges, double least, double most) {
  const auto from = static_cast<float>(least);
  const auto to = most > 0 ? static_cast<float>(most) : std::numeric_limits<float>::max();
  for (float& range : ranges) {
    if (!(range > 0 && range >= from && range <= to)) range = 0;
  }
}

}  // namespace

ScanDecoder::ScanDecoder(RosMessageSchema layout, RosEncoding encoding, std::string prefix, bool multi_echo)
    : layout_(std::move(layout)), encoding_(encoding), multi_echo_(multi_echo) {
  const auto field = [&](std::string_view name) { return field_below(layout_, prefix, name); };
  sec_ = field("header.stamp.sec");
  nanosec_ = field("header.stamp.nanosec");
  angle_min_ = field("angle_min");
  angle_increment_ = field("angle_increment");
  time_increment_ = field("time_increment");
  scan_time_ = field("scan_time");
  range_min_ = field("range_min");
  range_max_ = field("range_max");
  ranges_ = field(multi_echo ? "ranges.echoes" : "ranges");
  intensities_ = field(multi_echo ? "intensities.echoes" : "intensities");
  for (const std::size_t list : {ranges_, intensities_}) {
    if (layout_.fields[list].type != RosType::float32 || layout_.fields[list].count != RosCount::counted)
      throw BagDamage{kNoScan};
  }
}

std::optional<ScanDecoder> ScanDecoder::of(const BagConnection& connection) {
  auto layout = parse_ros_layout(connection.type, connection.definition);
  if (!layout || connection.encoding == RosEncoding::other) return std::nullopt;
  const auto single = layout->find_type("sensor_msgs/LaserScan");
  const auto scan = single ? single : layout->find_type("sensor_msgs/MultiEchoLaserScan");
  if (!scan) return std::nullopt;
  const std::string prefix = layout->fields[*scan].path;
  try {
    return ScanDecoder(std::move(*layout), connection.encoding, prefix, !single);
  } catch (const BagDamage&) {
    return std::nullopt;
  }
}

ScanMessage ScanDecoder::decode(std::string_view message) const {
  ScanMessage scan;
  double least = 0, most = 0;
  std::vector<std::vector<float>> ranges, remissions;
  for (const RosValue& value : decode_ros(layout_, encoding_, message)) {
    const auto number = [&] { return value.number(layout_.fields[value.field].type); };
    const auto integer = [&] { return value.integer(layout_.fields[value.field].type); };
    if (value.field == sec_) scan.stamp_ns += kSecondInNs * (integer() & 0xffffffff);
    if (value.field == nanosec_) scan.stamp_ns += integer();
    if (value.field == angle_min_) scan.angle_min = number();
    if (value.field == angle_increment_) scan.angle_increment = number();
    if (value.field == time_increment_) scan.time_increment = number();
    if (value.field == scan_time_) scan.scan_time = number();
    if (value.field == range_min_) least = number();
    if (value.field == range_max_) most = number();
    if (value.field == ranges_) ranges.push_back(floats_of(value));
    if (value.field == intensities_) remissions.push_back(floats_of(value));
  }
  for (const double value : {scan.angle_min, scan.angle_increment, scan.time_increment, scan.scan_time}) {
    constexpr double kMax = 1000;
    if (!(std::abs(value) <= kMax)) throw BagDamage{kNoScan};
  }
  if (multi_echo_) {
    ranges = by_echo(ranges);
    remissions = by_echo(remissions);
  }
  for (std::size_t e = 0; e < ranges.size(); ++e) {
    mark_no_echoes(ranges[e], least, most);
    const bool has_remissions = e < remissions.size() && remissions[e].size() == ranges[e].size();
    scan.echoes.push_back({.ranges = std::move(ranges[e]),
                           .remissions = has_remissions ? std::move(remissions[e]) : std::vector<float>{}});
  }
  return scan;
}

/// Finds the quaternion that holds the angle: of a frame of tf, or the field that the rig names.
bool AngleDecoder::find_rotation(const BagConnection& connection, const RigPlate& plate) {
  const bool is_tf = connection.type == "tf2_msgs/TFMessage" || connection.type == "tf/tfMessage";
  const auto field = layout_.find(is_tf ? "transforms.transform.rotation" : plate.field);
  if (!field || layout_.fields[*field].name != "geometry_msgs/Quaternion") return false;
  if (!is_tf && layout_.fields[*field].is_in_list) return false;
  quaternion_ = layout_.fields[*field].parts.at(0);
  if (!is_tf) return true;
  frames_ = layout_.find("transforms.child_frame_id");
  sec_ = layout_.find("transforms.header.stamp.sec");
  nanosec_ = layout_.find("transforms.header.stamp.nanosec");
  if (plate.topic == connection.topic && plate.joint.empty())
    throw Error(
        fmt::format("{}, the topic of {}, holds transforms of several frames", plate.topic, plate.name),
        "name the frame that turns as 'joint' in the rig: its child_frame_id");
  return frames_ && sec_ && nanosec_;
}

std::optional<AngleDecoder> AngleDecoder::of(const BagConnection& connection, const RigPlate& plate) {
  auto layout = parse_ros_layout(connection.type, connection.definition);
  if (!layout || connection.encoding == RosEncoding::other) return std::nullopt;
  AngleDecoder decoder;
  decoder.encoding_ = connection.encoding;
  decoder.joint_ = plate.joint;
  decoder.layout_ = *layout;
  if (const RosField* stamp = layout->stamp()) {
    decoder.sec_ = stamp->parts.at(0);
    decoder.nanosec_ = stamp->parts.at(1);
  }
  if (decoder.find_rotation(connection, plate)) return decoder;
  const bool is_joint_state = connection.type == "sensor_msgs/JointState";
  if (is_joint_state) decoder.joints_ = layout->find("name");
  const std::string path = is_joint_state ? "position" : plate.field.empty() ? "data" : plate.field;
  const auto value = layout->find(path);
  if (!value || (!is_joint_state && !is_number(layout->fields[*value]))) {
    if (plate.topic != connection.topic) return std::nullopt;
    throw Error(
        fmt::format("messages of {} are {}, which has no number '{}'", plate.topic, connection.type, path),
        "name the one with the plate's angle as 'field' in the rig: a.b for b within a");
  }
  decoder.value_ = *value;
  const RosType type = layout->fields[*value].type;
  const bool is_whole = type != RosType::float32 && type != RosType::float64;
  const AngleUnit unit = plate.unit.value_or(is_whole ? AngleUnit::counts : AngleUnit::rad);
  if (unit == AngleUnit::deg) decoder.scale_ = std::numbers::pi / 180;
  if (unit == AngleUnit::counts) decoder.scale_ = std::abs(plate.angle_per_count());
  return decoder;
}

std::optional<AngleMessage> AngleDecoder::decode_rotation(std::string_view message) const {
  std::int64_t sec = 0, nanosec = 0;
  bool is_joint = !frames_;
  std::array<double, 4> xyzw{};
  for (const RosValue& value : decode_ros(layout_, encoding_, message)) {
    const RosType type = layout_.fields[value.field].type;
    if (value.field == sec_) sec = value.integer(type) & 0xffffffff;
    if (value.field == nanosec_) nanosec = value.integer(type);
    if (value.field == frames_) is_joint = value.bytes == joint_ || value.bytes == "/" + joint_;
    const std::size_t i = value.field - *quaternion_;
    if (!is_joint || value.field < *quaternion_ || i >= xyzw.size()) continue;
    xyzw[i] = value.number(type);
    if (i + 1 < xyzw.size()) continue;
    AngleMessage reading{.rotation = xyzw};
    if (sec_) reading.stamp_ns = kSecondInNs * sec + nanosec;
    return reading;
  }
  return std::nullopt;
}

std::optional<AngleMessage> AngleDecoder::decode(std::string_view message) const {
  if (quaternion_) return decode_rotation(message);
  AngleMessage reading;
  std::int64_t stamp = 0;
  std::size_t joints = 0;
  std::optional<std::size_t> joint;  // which of them
  if (!joints_ || joint_.empty()) joint = 0;
  std::optional<RosValue> position;
  for (const RosValue& value : decode_ros(layout_, encoding_, message)) {
    const RosType type = layout_.fields[value.field].type;
    if (value.field == sec_) stamp += kSecondInNs * (value.integer(type) & 0xffffffff);
    if (value.field == nanosec_) stamp += value.integer(type);
    if (value.field == joints_) {
      if (value.bytes == joint_) joint = joints;
      ++joints;
    }
    if (value.field == value_) position = value;
  }
  if (sec_) reading.stamp_ns = stamp;
  if (joints_ && joint_.empty() && joints > 1)
    throw BagDamage{"joint states of several joints, none of which the rig names"};
  if (!joint || !position || *joint >= position->count) return std::nullopt;
  reading.angle = scale_ * position->number(layout_.fields[value_].type, *joint);
  constexpr double kLargest = 1e9;
  if (!(std::abs(reading.angle) <= kLargest)) throw BagDamage{"impossible angles of the plate"};
  return reading;
}

}  // namespace crisp::bag
