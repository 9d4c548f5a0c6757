// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/ray_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <crisp/error.hpp>

namespace crisp::simulate {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kLeaf = 3;  // things in a leaf: testing them costs about as much as one more box
constexpr std::size_t kDepth = 64;  // halving 2^32 things needs 32
constexpr double kStart = 1e-9;     // [m] a ray does not hit what it starts on
constexpr double kFlatness = 1e-6;  // [m] how far a corner may lie off the plane

/// Twice the polygon's area, along its normal (Newell).
Vector3d area_vector(const std::vector<Vector3d>& corners) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum += corners[i].cross(corners[(i + 1) % corners.size()]);
  }
  return sum;
}

Vector3d checked_normal(const Surface& surface) {
  if (surface.corners.size() < 3)
    throw Error("the surface " + surface.name + " has " + std::to_string(surface.corners.size()) + " corners",
                "give three corners or more");
  const Vector3d area = area_vector(surface.corners);
  if (!(area.norm() > 1e-12))
    throw Error("the surface " + surface.name + " has no area", "move its corners apart, off one line");
  Vector3d normal = area.normalized();
  for (const auto& corner : surface.corners) {
    const double off = std::abs(normal.dot(corner - surface.corners.front()));
    if (off > kFlatness) {
      throw Error("the corners of the surface " + surface.name + " do not lie in one plane",
                  "split it into triangles");
    }
  }
  return normal;
}

/// Distance at which the ray enters the box, or infinity if it misses it.
double entry(const Eigen::AlignedBox3d& box, const Ray& ray, const Vector3d& inverse) {
  const Eigen::Array3d a = (box.min() - ray.origin).array() * inverse.array();
  const Eigen::Array3d b = (box.max() - ray.origin).array() * inverse.array();
  const double in = a.min(b).maxCoeff();
  const double out = a.max(b).minCoeff();
  return out >= std::max(in, 0.0) ? in : std::numeric_limits<double>::infinity();
}

double distance_to_segment(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double u = std::clamp(along.dot(point - a) / along.squaredNorm(), 0.0, 1.0);
  return (a + u * along - point).norm();
}

/// Intersection of a beam with a body.
std::optional<Hit> stop(const Body& body, const Ray& ray, const Shot& shot) {
  const Vector3d off = body.walk.at(shot.time);
  const auto inside = passage(body.shape, {.origin = ray.origin - off, .direction = ray.direction});
  if (!inside || !(inside->out > kStart)) return std::nullopt;
  if (body.depth > 0) {
    const double depth = shot.chance ? shot.chance->exponential(body.depth) : body.depth;
    const double distance = std::max(inside->in, kStart) + depth;
    if (distance >= inside->out) return std::nullopt;
    return Hit{.distance = distance, .cos_incidence = 0.5};  // the mean over leaves of all directions
  }
  const double distance = inside->in > kStart ? inside->in : inside->out;
  const Vector3d normal = normal_at(body.shape, ray.origin - off + distance * ray.direction);
  return Hit{.distance = distance, .cos_incidence = std::abs(normal.dot(ray.direction))};
}

}  // namespace

RayCaster::Polygon::Polygon(const Surface& surface)
    : normal(checked_normal(surface)), corners(surface.corners) {
  offset = normal.dot(corners.front());
  int steepest = 0;
  normal.cwiseAbs().maxCoeff(&steepest);
  axis_u = (steepest + 1) % 3;
  axis_v = (steepest + 2) % 3;
  for (const auto& c : corners) outline.emplace_back(c[axis_u], c[axis_v]);
}

Eigen::AlignedBox3d RayCaster::Polygon::bounds() const {
  Eigen::AlignedBox3d box;
  for (const auto& corner : corners) box.extend(corner);
  return box;
}

bool RayCaster::Polygon::covers(const Vector3d& point) const {
  const double u = point[axis_u];
  const double v = point[axis_v];
  bool inside = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const auto& a = outline[i];
    const auto& b = outline[j];
    if ((a.y() > v) != (b.y() > v) && u < (b.x() - a.x()) * (v - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  return inside;
}

std::optional<Hit> RayCaster::Polygon::cast(const Ray& ray, double within) const {
  const double slope = normal.dot(ray.direction);
  const double distance = (offset - normal.dot(ray.origin)) / slope;
  if (!(distance > kStart && distance <= within)) return std::nullopt;
  if (!covers(ray.origin + distance * ray.direction)) return std::nullopt;
  return Hit{.distance = distance, .cos_incidence = std::abs(slope)};
}

double RayCaster::Polygon::distance(const Vector3d& point) const {
  const double height = normal.dot(point) - offset;
  if (covers(point - height * normal)) return std::abs(height);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    nearest = std::min(nearest, distance_to_segment(point, corners[i], corners[j]));
  }
  return nearest;
}

RayCaster::RayCaster(const Scene& scene) : bodies_(scene.bodies) {
  std::vector<Eigen::AlignedBox3d> bounds;
  for (const auto& surface : scene.surfaces) {
    order_.push_back(static_cast<std::uint32_t>(bounds.size()));
    bounds.push_back(polygons_.emplace_back(surface).bounds());
  }
  for (const auto& body : bodies_) {
    check(body.shape, body.name);
    (body.walk.moves() ? moving_ : order_).push_back(static_cast<std::uint32_t>(bounds.size()));
    bounds.push_back(simulate::bounds(body.shape));
  }
  if (!order_.empty()) split(0, static_cast<std::uint32_t>(order_.size()), bounds);
}

void RayCaster::split(std::uint32_t begin, std::uint32_t end,
                      const std::vector<Eigen::AlignedBox3d>& bounds) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d centres;
  for (auto i = begin; i < end; ++i) {
    box.extend(bounds[order_[i]]);
    centres.extend(bounds[order_[i]].center());
  }
  // Rounding in a hit's position must not put it outside the box of a wall without thickness.
  nodes_[self].box = {box.min().array() - 1e-9, box.max().array() + 1e-9};
  if (end - begin <= kLeaf) {
    nodes_[self].first = begin;
    nodes_[self].count = end - begin;
    return;
  }
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const auto middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](auto a, auto b) { return bounds[a].center()[axis] < bounds[b].center()[axis]; });
  split(begin, middle, bounds);
  nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
  split(middle, end, bounds);
}

std::optional<Hit> RayCaster::cast_at(std::uint32_t thing, const Ray& ray, double within,
                                      const Shot& shot) const {
  if (thing < polygons_.size()) return polygons_[thing].cast(ray, within);
  return stop(bodies_[thing - polygons_.size()], ray, shot);
}

std::optional<Hit> RayCaster::cast(const Ray& ray, double max_distance, const Shot& shot) const {
  const Vector3d inverse = ray.direction.cwiseInverse();
  Hit nearest{.distance = max_distance};
  bool found = false;
  const auto try_one = [&](std::uint32_t thing) {
    const auto hit = cast_at(thing, ray, nearest.distance, shot);
    if (!hit || hit->distance > nearest.distance) return;
    nearest = *hit;
    nearest.surface = thing;
    found = true;
  };
  std::array<std::uint32_t, kDepth> stack{};
  std::size_t depth = 0;
  if (!nodes_.empty()) stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t at = stack[--depth];
    const Node& node = nodes_[at];
    if (entry(node.box, ray, inverse) > nearest.distance) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = at + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) try_one(order_[i]);
  }
  for (const std::uint32_t thing : moving_) try_one(thing);
  return found ? std::optional(nearest) : std::nullopt;
}

double RayCaster::distance_to(std::uint32_t thing, const Vector3d& point) const {
  if (thing < polygons_.size()) return polygons_[thing].distance(point);
  const Body& body = bodies_[thing - polygons_.size()];
  return body.depth > 0 && is_inside(body.shape, point) ? 0 : distance_to_surface(body.shape, point);
}

double RayCaster::distance(const Vector3d& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return nearest;
  std::array<std::uint32_t, kDepth> stack{};
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t at = stack[--depth];
    const Node& node = nodes_[at];
    if (node.box.exteriorDistance(point) > nearest) continue;
    if (node.count == 0) {
      std::uint32_t near = at + 1;
      std::uint32_t far = node.first;
      if (nodes_[far].box.squaredExteriorDistance(point) < nodes_[near].box.squaredExteriorDistance(point)) {
        std::swap(near, far);
      }
      stack[depth++] = far;
      stack[depth++] = near;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      nearest = std::min(nearest, distance_to(order_[i], point));
    }
  }
  return nearest;
}

}  // namespace crisp::simulate
