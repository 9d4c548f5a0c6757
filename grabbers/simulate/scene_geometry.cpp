// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scene_geometry.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "grabbers/simulate/point_yaml.hpp"
#include "grabbers/simulate/shapes.hpp"
#include "pipeline/files/nearest.hpp"

namespace crisp::simulate {
namespace {

using Eigen::Vector3d;
using files::YamlMap;
using files::YamlNode;
using ErrorList = std::vector<Error>;

Scene one(Body body) { return {.name = "", .surfaces = {}, .bodies = {std::move(body)}}; }

Scene flat(std::vector<Surface> surfaces) {
  return {.name = "", .surfaces = std::move(surfaces), .bodies = {}};
}

Scene read_box(const YamlNode& node, bool as_body, ErrorList& errors) {
  YamlMap map(node, "box", errors);
  const Vector3d from = require_vector(map, "from", errors);
  const Vector3d to = require_vector(map, "to", errors);
  map.refuse_others();
  if (!as_body) return flat(box("box", from, to, 0.5));
  return one({.name = "box", .shape = Block{.middle = (from + to) / 2, .half = (to - from).cwiseAbs() / 2}});
}

Scene read_rectangle(const YamlNode& node, bool, ErrorList& errors) {
  YamlMap map(node, "rectangle", errors);
  const Vector3d corner = require_vector(map, "corner", errors);
  const Vector3d a = require_vector(map, "a", errors);
  const Vector3d b = require_vector(map, "b", errors);
  map.refuse_others();
  return flat({rectangle("rectangle", corner, a, b, 0.5)});
}

Scene read_polygon(const YamlNode& node, bool, ErrorList& errors) {
  return flat({Surface{"polygon", read_points(node, "polygon", 3, errors)}});
}

Scene read_walls(const YamlNode& node, bool, ErrorList& errors) {
  YamlMap map(node, "walls", errors);
  std::vector<Eigen::Vector2d> outline;
  if (const YamlNode* points = map.require("outline")) {
    for (const auto& point : read_points(*points, "outline", 2, errors)) {
      outline.emplace_back(point.x(), point.y());
    }
  }
  const double from = read_bounded(map, "from", "m", 0, kMaxLength);
  const double to = read_bounded(map, "to", "m", 3, kMaxLength);
  map.refuse_others();
  return flat(walls("wall", outline, from, to, 0.5));
}

Scene read_cylinder(const YamlNode& node, bool, ErrorList& errors) {
  YamlMap map(node, "cylinder", errors);
  Cylinder cylinder{.from = require_vector(map, "from", errors), .to = require_vector(map, "to", errors)};
  map.require("radius");
  cylinder.radius = read_bounded(map, "radius", "m", 1, kMaxLength);
  map.refuse_others();
  return one({.name = "cylinder", .shape = cylinder});
}

Scene read_sphere(const YamlNode& node, bool, ErrorList& errors) {
  YamlMap map(node, "sphere", errors);
  const Vector3d middle = require_vector(map, "middle", errors);
  map.require("radius");
  const double radius = read_bounded(map, "radius", "m", 1, kMaxLength);
  map.refuse_others();
  return one({.name = "sphere", .shape = Ellipsoid{.middle = middle, .radii = Vector3d::Constant(radius)}});
}

Scene read_ellipsoid(const YamlNode& node, bool, ErrorList& errors) {
  YamlMap map(node, "ellipsoid", errors);
  const Ellipsoid ellipsoid{.middle = require_vector(map, "middle", errors),
                            .radii = require_vector(map, "radii", errors)};
  map.refuse_others();
  return one({.name = "ellipsoid", .shape = ellipsoid});
}

using ReadShape = Scene (*)(const YamlNode& node, bool as_body, ErrorList& errors);
constexpr std::array<std::pair<const char*, ReadShape>, 7> kReaders = {{{"box", read_box},
                                                                        {"rectangle", read_rectangle},
                                                                        {"polygon", read_polygon},
                                                                        {"walls", read_walls},
                                                                        {"cylinder", read_cylinder},
                                                                        {"sphere", read_sphere},
                                                                        {"ellipsoid", read_ellipsoid}}};

Scene read_shape(YamlMap& item, const YamlNode& node, const std::map<std::string, Scene>& shapes) {
  const std::string name = item.text("shape", "");
  const auto found = shapes.find(name);
  if (found != shapes.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [other, things] : shapes) known.push_back(other);
  item.fail(node.place, "there is no shape '" + name + "'",
            files::did_you_mean(name, known, "describe it under shapes, before it is used"));
  return {};
}

}  // namespace

Scene read_geometry(YamlMap& item, const Place& place, const std::map<std::string, Scene>& shapes,
                    std::vector<Error>& errors) {
  const auto errors_before = errors.size();
  const bool as_body = item.find("depth") != nullptr || item.find("walk") != nullptr;
  Scene things;
  int kinds = 0;
  for (const auto& [kind, read] : kReaders) {
    const YamlNode* node = item.find(kind);
    if (!node) continue;
    ++kinds;
    things = read(*node, as_body, errors);
  }
  if (const YamlNode* node = item.find("shape")) {
    ++kinds;
    things = read_shape(item, *node, shapes);
  }
  if (kinds != 1 && errors.size() == errors_before) {
    item.fail(place, fmt::format("there are {} shapes in one item", kinds),
              "give one of box, rectangle, polygon, walls, cylinder, sphere, ellipsoid and shape");
  }
  return things;
}

}  // namespace crisp::simulate
