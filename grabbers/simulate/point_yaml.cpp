// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/point_yaml.hpp"

#include <fmt/format.h>

#include <cmath>

namespace crisp::simulate {

using Eigen::Vector3d;

Vector3d read_point(const files::YamlNode& node, const std::string& what, std::size_t dimensions,
                    std::vector<Error>& errors) {
  Vector3d result = Vector3d::Zero();
  if (node.kind != files::YamlNode::Kind::sequence || node.items.size() != dimensions) {
    errors.emplace_back(
        fmt::format("{}: {} is not a list of {} lengths", what, files::describe(node), dimensions),
        dimensions == 2 ? "write [1m, 2m]" : "write [1m, 2m, 3m]", node.place);
    return result;
  }
  for (std::size_t i = 0; i < dimensions; ++i) {
    std::string wrong;
    const auto value = files::read_number(node.items[i], "m", wrong);
    if (value && std::abs(*value) > kMaxLength) wrong = fmt::format("{:g} m is implausible", *value);
    if (!wrong.empty()) {
      errors.emplace_back(fmt::format("{}: {}", what, wrong),
                          fmt::format("expected is a number in m, {:g} at most", kMaxLength),
                          node.items[i].place);
    } else {
      result[static_cast<Eigen::Index>(i)] = *value;
    }
  }
  return result;
}

std::vector<Vector3d> read_points(const files::YamlNode& node, const std::string& what,
                                  std::size_t dimensions, std::vector<Error>& errors) {
  std::vector<Vector3d> points;
  if (node.kind != files::YamlNode::Kind::sequence) {
    errors.emplace_back(what + ": " + files::describe(node) + " is not a list of points",
                        dimensions == 2 ? "write [[0, 0], [3, 0]]" : "write [[0, 0, 0], [3, 0, 0]]",
                        node.place);
  }
  for (const auto& item : node.items) points.push_back(read_point(item, what, dimensions, errors));
  return points;
}

Vector3d read_vector(files::YamlMap& map, const std::string& key, const Vector3d& fallback,
                     std::vector<Error>& errors) {
  const files::YamlNode* node = map.find(key);
  return node ? read_point(*node, "'" + key + "'", 3, errors) : fallback;
}

Vector3d require_vector(files::YamlMap& map, const std::string& key, std::vector<Error>& errors) {
  map.require(key);
  return read_vector(map, key, Vector3d::Zero(), errors);
}

double read_bounded(files::YamlMap& map, const std::string& key, const std::string& unit, double fallback,
                    double most) {
  const double value = map.number(key, unit, fallback);
  if (std::abs(value) <= most) return value;
  map.fail(map.find(key)->place,
           fmt::format("'{}': {:g}{} is implausible", key, value, unit.empty() ? "" : " " + unit),
           fmt::format("its magnitude is at most {:g}{}", most, unit.empty() ? "" : " " + unit));
  return fallback;
}

}  // namespace crisp::simulate
