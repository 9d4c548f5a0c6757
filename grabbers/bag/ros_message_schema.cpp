// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/ros_message_schema.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <sstream>
#include <utility>

#include "grabbers/bag/byte_cursor.hpp"
#include "grabbers/bag/ros_names.hpp"

namespace crisp::bag {
namespace {

const std::map<std::string, RosType, std::less<>> kPrimitives = {
    {"bool", RosType::boolean},    {"byte", RosType::uint8},    {"char", RosType::uint8},
    {"int8", RosType::int8},       {"uint8", RosType::uint8},   {"int16", RosType::int16},
    {"uint16", RosType::uint16},   {"int32", RosType::int32},   {"uint32", RosType::uint32},
    {"int64", RosType::int64},     {"uint64", RosType::uint64}, {"float32", RosType::float32},
    {"float64", RosType::float64}, {"string", RosType::text}};

/// A line of a definition: "float32[] ranges".
struct DefinedField {
  std::string type, name;
  RosCount count = RosCount::one;
  std::uint32_t fixed = 1;
};
using Definitions = std::map<std::string, std::vector<DefinedField>, std::less<>>;

const std::string kTime = "builtin_interfaces/Time";  // of sec and nanosec

constexpr const char* kUnreadable = "unreadable definitions of messages";

/// Splits "float32[36]" and the like: removes the brackets and sets the array's length.
void take_brackets(DefinedField& field) {
  const auto open = field.type.find('[');
  if (open == std::string::npos) return;
  const std::string inside = field.type.substr(open + 1, field.type.find(']') - open - 1);
  field.type.resize(open);
  field.count = RosCount::counted;
  if (inside.empty() || inside.starts_with("<=")) return;
  field.count = RosCount::fixed;
  const auto read = std::from_chars(inside.data(), inside.data() + inside.size(), field.fixed);
  if (read.ec != std::errc() || read.ptr != inside.data() + inside.size()) throw BagDamage{kUnreadable};
}

/// Nothing for lines without a field: constants (int32 A=1), comments, empty ones.
std::optional<DefinedField> field_of(const std::string& line) {
  std::istringstream words(line.substr(0, line.find('#')));
  DefinedField field;
  std::string next;
  if (!(words >> field.type)) return std::nullopt;
  if (!(words >> field.name)) throw BagDamage{kUnreadable};
  words >> next;
  if (field.name.find('=') != std::string::npos || next.starts_with('=')) return std::nullopt;
  take_brackets(field);
  field.type.resize(std::min(field.type.size(), field.type.find("<=")));  // string<=10
  return field;
}

/// "Header" → "std_msgs/Header", "Point" in geometry_msgs/Pose → "geometry_msgs/Point".
std::string qualified(const std::string& type, const std::string& within) {
  if (type == "Header") return "std_msgs/Header";
  if (type == "time") return kTime;
  if (type == "duration") return "builtin_interfaces/Duration";
  if (type.find('/') != std::string::npos) return plain_ros_type(type);
  return within.substr(0, within.find('/')) + "/" + type;
}

Definitions parse_definitions(const std::string& type, const std::string& text) {
  Definitions all = {{kTime, {{"uint32", "sec"}, {"uint32", "nanosec"}}},
                     {"builtin_interfaces/Duration", {{"uint32", "sec"}, {"uint32", "nanosec"}}}};
  std::string current = type;
  std::istringstream lines(text);
  all[current].clear();
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("===")) continue;
    if (line.starts_with("MSG: ")) {
      current = line.substr(5, line.find_last_not_of(" \r\t") - 4);
      current = plain_ros_type(current);
      all[current].clear();
    } else if (auto field = field_of(line)) {
      if (!kPrimitives.contains(field->type)) field->type = qualified(field->type, current);
      all[current].push_back(std::move(*field));
    }
  }
  return all;
}

/// Builds the tree of fields of definitions.
class Grower {
 public:
  explicit Grower(const Definitions& definitions) : definitions_(definitions) {}

  RosMessageSchema grow(const std::string& type) {
    layout_.fields.push_back({.name = type});
    add_parts(0, 0);
    return std::move(layout_);
  }

 private:
  void add_parts(std::size_t of, int depth) {
    constexpr int kDeepest = 16;
    constexpr std::size_t kMax = 10'000;
    const auto defined = definitions_.find(layout_.fields[of].name);
    if (defined == definitions_.end() || depth > kDeepest) throw BagDamage{kUnreadable};
    for (const auto& part : defined->second) {
      const auto primitive = kPrimitives.find(part.type);
      const std::size_t index = layout_.fields.size();
      if (index > kMax) throw BagDamage{kUnreadable};
      const std::string& outer = layout_.fields[of].path;
      layout_.fields.push_back({.path = outer.empty() ? part.name : outer + "." + part.name,
                                .type = primitive == kPrimitives.end() ? RosType::message : primitive->second,
                                .name = part.type,
                                .count = part.count,
                                .fixed = part.fixed,
                                .is_in_list = layout_.fields[of].is_in_list || part.count != RosCount::one});
      layout_.fields[of].parts.push_back(index);
      if (primitive == kPrimitives.end()) add_parts(index, depth + 1);
    }
  }

  const Definitions& definitions_;
  RosMessageSchema layout_;
};

}  // namespace

std::size_t size_of(RosType type) {
  switch (type) {
    case RosType::boolean:
    case RosType::int8:
    case RosType::uint8:
      return 1;
    case RosType::int16:
    case RosType::uint16:
      return 2;
    case RosType::int32:
    case RosType::uint32:
    case RosType::float32:
      return 4;
    case RosType::int64:
    case RosType::uint64:
    case RosType::float64:
      return 8;
    case RosType::text:
    case RosType::message:
      break;
  }
  return 0;
}

std::optional<std::size_t> RosMessageSchema::find(std::string_view path) const {
  const auto found = std::ranges::find(fields, path, &RosField::path);
  return found == fields.end() ? std::nullopt
                               : std::optional(static_cast<std::size_t>(found - fields.begin()));
}

std::optional<std::size_t> RosMessageSchema::find_type(std::string_view name) const {
  const auto found = std::ranges::find(fields, name, &RosField::name);
  return found == fields.end() ? std::nullopt
                               : std::optional(static_cast<std::size_t>(found - fields.begin()));
}

const RosField* RosMessageSchema::stamp() const {
  const auto found = std::ranges::find_if(fields, [](const RosField& field) {
    return field.name == kTime && !field.is_in_list && field.path.ends_with("stamp");
  });
  return found == fields.end() ? nullptr : &*found;
}

std::optional<RosMessageSchema> parse_ros_layout(const std::string& type, const std::string& definition) {
  const std::string text = definition.empty() ? known_ros_definition(type) : definition;
  if (text.empty()) return std::nullopt;
  try {
    return Grower(parse_definitions(type, text)).grow(type);
  } catch (const BagDamage&) {
    return std::nullopt;
  }
}

}  // namespace crisp::bag
