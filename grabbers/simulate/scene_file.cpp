// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scene_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "grabbers/simulate/ray_caster.hpp"
#include "grabbers/simulate/shapes.hpp"
#include "pipeline/files/nearest.hpp"
#include "pipeline/files/yaml_map.hpp"

namespace crisp {
namespace {

using Eigen::Vector3d;
using Surfaces = std::vector<Surface>;

constexpr std::size_t kMostSurfaces = 200'000;  // of all shapes together, so that memory stays bounded
constexpr double kFarthest = 1e5;               // [m] nothing stands farther off

void add(Surfaces& to, const Surfaces& surfaces) { to.insert(to.end(), surfaces.begin(), surfaces.end()); }

class SceneReader {
 public:
  Scene read(const YamlNode& root) {
    YamlMap map(root, "scene", errors_);
    check_schema(map, 1);
    Scene scene{.name = map.text("name", "scene"), .surfaces = {}};
    if (const YamlNode* shapes = map.find("shapes")) read_shapes(*shapes);
    if (const YamlNode* surfaces = map.require("surfaces"))
      scene.surfaces = read_items(*surfaces, "surfaces");
    if (const YamlNode* scanner = map.require("scanner")) stand(*scanner, scene.surfaces);
    map.refuse_others();
    if (!errors_.empty()) throw Errors(std::move(errors_));
    return scene;
  }

 private:
  void read_shapes(const YamlNode& node) {
    YamlMap map(node, "shapes", errors_);
    for (const auto& entry : node.entries) {
      shapes_[entry.key] = read_items(entry.value, "shape '" + entry.key + "'");
    }
  }

  Surfaces read_items(const YamlNode& node, const std::string& what) {
    Surfaces surfaces;
    if (node.kind != YamlNode::Kind::sequence) {
      fail(node.place, what + ": " + crisp::describe(node) + " is not a list of surfaces");
    }
    for (const auto& item : node.items) {
      add(surfaces, read_item(item, what));
      if (total_ > kMostSurfaces) break;
    }
    return surfaces;
  }

  /// One box, rectangle, polygon, run of walls or shape: turned, moved, repeated.
  Surfaces read_item(const YamlNode& node, const std::string& what) {
    YamlMap map(node, what, errors_);
    if (node.kind != YamlNode::Kind::map) return {};
    Surfaces surfaces = read_geometry(map, node.place);
    const std::string name = map.text("name", "");
    const bool has_reflectance = map.find("reflectance") != nullptr;
    const double reflectance = map.number("reflectance", "", 0.5);
    if (!(reflectance >= 0 && reflectance <= 1)) {
      map.fail(map.find("reflectance")->place, "'reflectance' is not between 0 and 1");
    }
    for (auto& surface : surfaces) {
      if (!name.empty()) surface.name = name;
      if (has_reflectance) surface.reflectance = reflectance;
    }
    turn(surfaces, {0, 0}, map.number("yaw", "rad", 0));
    move(surfaces, vector(map, "at", Vector3d::Zero()));
    if (const YamlNode* repetition = map.find("repeat")) surfaces = repeated(*repetition, surfaces);
    map.refuse_others();
    check(surfaces, node.place);
    total_ += surfaces.size();
    if (total_ > kMostSurfaces) map.fail(node.place, fmt::format("more than {} surfaces", kMostSurfaces));
    return surfaces;
  }

  Surfaces read_geometry(YamlMap& map, const Place& place) {
    const auto errors_before = errors_.size();
    Surfaces surfaces;
    int kinds = 0;
    if (const YamlNode* node = map.find("box")) {
      ++kinds;
      surfaces = read_box(*node);
    }
    if (const YamlNode* node = map.find("rectangle")) {
      ++kinds;
      surfaces = read_rectangle(*node);
    }
    if (const YamlNode* node = map.find("polygon")) {
      ++kinds;
      surfaces = {Surface{"polygon", read_points(*node, "polygon")}};
    }
    if (const YamlNode* node = map.find("walls")) {
      ++kinds;
      surfaces = read_walls(*node);
    }
    if (map.find("shape")) {
      ++kinds;
      surfaces = read_shape(map);
    }
    if (kinds != 1 && errors_.size() == errors_before) {
      fail(place, "a surface is one of box, rectangle, polygon, walls and shape");
    }
    return surfaces;
  }

  Surfaces read_box(const YamlNode& node) {
    YamlMap map(node, "box", errors_);
    const Vector3d from = required_vector(map, "from");
    const Vector3d to = required_vector(map, "to");
    map.refuse_others();
    return box("box", from, to, 0.5);
  }

  Surfaces read_rectangle(const YamlNode& node) {
    YamlMap map(node, "rectangle", errors_);
    const Vector3d corner = required_vector(map, "corner");
    const Vector3d a = required_vector(map, "a");
    const Vector3d b = required_vector(map, "b");
    map.refuse_others();
    return {rectangle("rectangle", corner, a, b, 0.5)};
  }

  Surfaces read_walls(const YamlNode& node) {
    YamlMap map(node, "walls", errors_);
    std::vector<Eigen::Vector2d> outline;
    if (const YamlNode* points = map.require("outline")) {
      for (const auto& point : read_points(*points, "outline", 2)) outline.emplace_back(point.x(), point.y());
    }
    const double from = map.number("from", "m", 0);
    const double to = map.number("to", "m", 3);
    map.refuse_others();
    return walls("wall", outline, from, to, 0.5);
  }

  Surfaces read_shape(YamlMap& map) {
    const std::string name = map.text("shape", "");
    const auto found = shapes_.find(name);
    if (found != shapes_.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [other, surfaces] : shapes_) known.push_back(other);
    map.fail(map.find("shape")->place, "there is no shape '" + name + "'",
             did_you_mean(name, known, "describe it under shapes, before it is used"));
    return {};
  }

  Surfaces repeated(const YamlNode& node, const Surfaces& surfaces) {
    YamlMap map(node, "repeat", errors_);
    map.require("count");
    const auto count = static_cast<std::size_t>(map.integer("count", 1, 1, 10'000));
    const Vector3d step = required_vector(map, "step");
    map.refuse_others();
    if (surfaces.size() * count > kMostSurfaces) {
      map.fail(node.place, fmt::format("more than {} surfaces", kMostSurfaces));
      return surfaces;
    }
    Surfaces all;
    for (std::size_t i = 0; i < count; ++i) {
      Surfaces copy = surfaces;
      move(copy, static_cast<double>(i) * step);
      add(all, copy);
    }
    return all;
  }

  void stand(const YamlNode& node, Surfaces& surfaces) {
    YamlMap map(node, "scanner", errors_);
    const Vector3d position = required_vector(map, "position");
    const double yaw = map.number("yaw", "rad", 0);
    map.refuse_others();
    look_from(surfaces, position, yaw);
  }

  /// Refuses what is not flat or has no area where it stands in the file.
  void check(const Surfaces& surfaces, const Place& place) {
    for (const auto& surface : surfaces) {
      try {
        RayCaster(Scene{"", {surface}});
      } catch (const Error& error) {
        fail(place, error.message(), error.advice());
        return;
      }
    }
  }

  static void move(Surfaces& surfaces, const Vector3d& by) {
    for (auto& surface : surfaces) {
      for (auto& corner : surface.corners) corner += by;
    }
  }

  Vector3d required_vector(YamlMap& map, const std::string& key) {
    map.require(key);
    return vector(map, key, Vector3d::Zero());
  }

  Vector3d vector(YamlMap& map, const std::string& key, const Vector3d& fallback) {
    const YamlNode* node = map.find(key);
    return node ? point(*node, "'" + key + "'", 3) : fallback;
  }

  std::vector<Vector3d> read_points(const YamlNode& node, const std::string& what,
                                    std::size_t dimensions = 3) {
    std::vector<Vector3d> points;
    if (node.kind != YamlNode::Kind::sequence) {
      fail(node.place, what + ": " + crisp::describe(node) + " is not a list of points");
    }
    for (const auto& item : node.items) points.push_back(point(item, what, dimensions));
    return points;
  }

  Vector3d point(const YamlNode& node, const std::string& what, std::size_t dimensions) {
    Vector3d result = Vector3d::Zero();
    if (node.kind != YamlNode::Kind::sequence || node.items.size() != dimensions) {
      fail(node.place,
           fmt::format("{}: {} is not a list of {} lengths", what, crisp::describe(node), dimensions));
      return result;
    }
    for (std::size_t i = 0; i < dimensions; ++i) {
      std::string wrong;
      const auto value = read_number(node.items[i], "m", wrong);
      if (value && std::abs(*value) > kFarthest) wrong = fmt::format("{:g} m cannot be meant", *value);
      if (!wrong.empty()) {
        fail(node.items[i].place, fmt::format("{}: {}", what, wrong));
      } else {
        result[static_cast<Eigen::Index>(i)] = *value;
      }
    }
    return result;
  }

  void fail(const Place& place, const std::string& what, const std::string& advice = {}) {
    errors_.emplace_back(what, advice, place);
  }

  std::map<std::string, Surfaces> shapes_;
  std::size_t total_ = 0;  ///< surfaces made so far
  std::vector<Error> errors_;
};

}  // namespace

Scene parse_scene(const YamlNode& root) { return SceneReader().read(root); }

Scene read_scene(const std::filesystem::path& file) { return parse_scene(read_yaml(file)); }

}  // namespace crisp
