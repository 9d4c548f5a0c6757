// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scene_file.hpp"

#include <fmt/format.h>

#include <map>
#include <numbers>
#include <optional>

#include "grabbers/simulate/point_yaml.hpp"
#include "grabbers/simulate/ray_caster.hpp"
#include "grabbers/simulate/scene_geometry.hpp"
#include "grabbers/simulate/shapes.hpp"
#include "pipeline/files/yaml_map.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {
namespace {

using Eigen::Vector3d;
using files::YamlMap;
using files::YamlNode;

constexpr std::size_t kMaxSurfaces = 200'000;  // of all shapes together, so that memory stays bounded
constexpr std::int64_t kMaxCopies = 10'000;
constexpr double kMaxSpeed = 1000;  // [m/s]
constexpr double kMaxTimes = 1e4;   // largest size factor of scattered copies, or its inverse

struct Stand {
  Vector3d position;
  double yaw;
};

class SceneReader {
 public:
  Scene read(const YamlNode& root) {
    YamlMap map(root, "scene", errors_);
    files::check_schema(map, 1);
    const std::string name = map.text("name", "scene");
    if (const YamlNode* shapes = map.find("shapes")) read_shapes(*shapes);
    if (const YamlNode* scanner = map.require("scanner")) stand_ = read_stand(*scanner);
    Scene scene;
    if (const YamlNode* surfaces = map.require("surfaces")) scene = read_items(*surfaces, "surfaces");
    scene.name = name;
    if (stand_) look_from(scene, stand_->position, stand_->yaw);
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

  Stand read_stand(const YamlNode& node) {
    YamlMap map(node, "scanner", errors_);
    Stand stand{.position = require_vector(map, "position", errors_),
                .yaw = read_bounded(map, "yaw", "rad", 0, kMaxYaw)};
    map.refuse_others();
    return stand;
  }

  Scene read_items(const YamlNode& node, const std::string& what) {
    Scene scene;
    if (node.kind != YamlNode::Kind::sequence) {
      fail(node.place, what + ": " + files::describe(node) + " is not a list of surfaces",
           "begin the line of each surface with '- '");
    }
    for (const auto& item : node.items) {
      add(scene, read_item(item, what));
      if (total_ > kMaxSurfaces) break;
    }
    return scene;
  }

  /// One item: its primitives, turned, moved, and repeated or scattered.
  Scene read_item(const YamlNode& node, const std::string& what) {
    YamlMap map(node, what, errors_);
    if (node.kind != YamlNode::Kind::map) return {};
    Scene scene = read_geometry(map, node.place, shapes_, errors_);
    read_look(map, scene);
    read_body(map, scene);
    check(scene, node.place);
    place(scene, read_bounded(map, "yaw", "rad", 0, kMaxYaw), Vector3d::Zero());
    place(scene, 0, read_vector(map, "at", Vector3d::Zero(), errors_));
    if (const YamlNode* repetition = map.find("repeat")) scene = repeated(*repetition, scene);
    if (const YamlNode* strewing = map.find("strew")) scene = mixed(*strewing, scene);
    map.refuse_others();
    total_ += scene.things();
    if (total_ > kMaxSurfaces)
      map.fail(node.place, fmt::format("more than {} surfaces", kMaxSurfaces), "leave some out");
    return scene;
  }

  static void read_look(YamlMap& map, Scene& scene) {
    const std::string name = map.text("name", "");
    const bool has_reflectance = map.find("reflectance") != nullptr;
    const double reflectance = map.number("reflectance", "", 0.5);
    if (!(reflectance >= 0 && reflectance <= 1)) {
      map.fail(map.find("reflectance")->place, fmt::format("'reflectance' is {:g}", reflectance),
               "give a share from 0 to 1");
    }
    const auto look = [&](auto& thing) {
      if (!name.empty()) thing.name = name;
      if (has_reflectance) thing.reflectance = reflectance;
    };
    for (auto& surface : scene.surfaces) look(surface);
    for (auto& body : scene.bodies) look(body);
  }

  /// Properties that only bodies can have: foliage and motion.
  void read_body(YamlMap& map, Scene& scene) {
    const YamlNode* depth = map.find("depth");
    const YamlNode* walk = map.find("walk");
    if (!depth && !walk) return;
    if (!scene.surfaces.empty()) {
      map.fail((depth ? depth : walk)->place, "flat surfaces can have neither depth nor a walk",
               "set them on each box, cylinder, sphere or ellipsoid of the shape");
    }
    const double reach = read_bounded(map, "depth", "m", 0, kMaxLength);
    if (depth && !(reach > 0))
      map.fail(depth->place, "'depth' is not above 0", "leave it out for a solid body");
    const Walk way = walk ? read_walk(*walk) : Walk{};
    for (auto& body : scene.bodies) {
      if (depth) body.depth = reach;
      if (walk) body.walk = way;
    }
  }

  Walk read_walk(const YamlNode& node) {
    YamlMap map(node, "walk", errors_);
    Walk walk;
    if (const YamlNode* along = map.require("along")) walk.along = read_points(*along, "along", 3, errors_);
    walk.speed = read_bounded(map, "speed", "m/s", 1.4, kMaxSpeed);
    map.refuse_others();
    double length = 0;
    for (std::size_t i = 1; i < walk.along.size(); ++i) length += (walk.along[i] - walk.along[i - 1]).norm();
    if (!(length > 0))
      fail(node.place, "the walk has no length", "give at least two places: along: [[0, 0, 0], [3, 0, 0]]");
    if (!(walk.speed > 0)) fail(node.place, "'speed' is not above 0", "leave out the walk of a body at rest");
    return walk;
  }

  Scene repeated(const YamlNode& node, const Scene& scene) {
    YamlMap map(node, "repeat", errors_);
    const std::size_t count = copies(map, node, scene);
    const Vector3d step = require_vector(map, "step", errors_);
    map.refuse_others();
    Scene all;
    for (std::size_t i = 0; i < count; ++i) {
      Scene copy = scene;
      place(copy, 0, static_cast<double>(i) * step);
      add(all, copy);
    }
    return all;
  }

  /// Copies at random places, turned at random and of random size.
  Scene mixed(const YamlNode& node, const Scene& scene) {
    YamlMap map(node, "strew", errors_);
    const std::size_t count = copies(map, node, scene);
    const Vector3d from = require_vector(map, "from", errors_);
    const Vector3d to = require_vector(map, "to", errors_);
    const auto seed = static_cast<std::uint64_t>(map.integer("seed", 1, 0, 1'000'000'000));
    const double smallest = read_bounded(map, "smallest", "", 1, kMaxTimes);
    const double largest = read_bounded(map, "largest", "", 1, kMaxTimes);
    const double clear = read_bounded(map, "clear", "m", 0, kMaxLength);
    map.refuse_others();
    if (!(smallest >= 1 / kMaxTimes && largest >= smallest)) {
      fail(node.place,
           fmt::format("the copies' sizes are from {:g} to {:g} times the original's", smallest, largest),
           "give 0.0001 <= smallest <= largest");
      return scene;
    }
    statistics::RandomStream random(seed, "strew");
    Scene all;
    for (std::size_t i = 0; i < count; ++i) {
      const auto where = place_in(from, to, clear, random);
      if (!where) {
        fail(node.place, "no place for scattered copies is clear of the scanner",
             "make the region larger, or `clear` smaller");
        break;
      }
      Scene copy = scene;
      const double yaw = random.uniform(0, 2 * std::numbers::pi);
      place(copy, yaw, *where, random.uniform(smallest, largest));
      add(all, copy);
    }
    return all;
  }

  /// A place in the region that is so far from the scanner, seen from above.
  std::optional<Vector3d> place_in(const Vector3d& from, const Vector3d& to, double clear,
                                   statistics::RandomStream& random) const {
    constexpr int kTries = 1000;
    for (int k = 0; k < kTries; ++k) {
      Vector3d where;
      for (int axis = 0; axis < 3; ++axis) where[axis] = random.uniform(from[axis], to[axis]);
      if (clear <= 0 || !stand_ || (where - stand_->position).head<2>().norm() >= clear) return where;
    }
    return std::nullopt;
  }

  /// Requested number of copies of a scene; 1 if it is too large.
  static std::size_t copies(YamlMap& map, const YamlNode& node, const Scene& scene) {
    map.require("count");
    const auto count = static_cast<std::size_t>(map.integer("count", 1, 1, kMaxCopies));
    if (scene.things() * count <= kMaxSurfaces) return count;
    map.fail(node.place, fmt::format("more than {} surfaces", kMaxSurfaces), "reduce count");
    return 1;
  }

  /// Refuses what is not flat or has no area or volume where it stands in the file.
  void check(const Scene& scene, const Place& place) {
    try {
      for (const auto& surface : scene.surfaces) RayCaster(Scene{.name = "", .surfaces = {surface}});
      for (const auto& body : scene.bodies) simulate::check(body.shape, body.name);
    } catch (const Error& error) {
      fail(place, error.message(), error.advice());
    }
  }

  void fail(const Place& place, const std::string& what, const std::string& advice) {
    errors_.emplace_back(what, advice, place);
  }

  std::map<std::string, Scene> shapes_;
  std::optional<Stand> stand_;
  std::size_t total_ = 0;  ///< things made so far
  std::vector<Error> errors_;
};

}  // namespace

Scene parse_scene(const YamlNode& root) { return SceneReader().read(root); }

Scene read_scene(const std::filesystem::path& file) { return parse_scene(files::read_yaml(file)); }

}  // namespace crisp::simulate
