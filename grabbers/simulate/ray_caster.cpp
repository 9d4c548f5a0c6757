// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/ray_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kLeaf = 3;  // polygons in a leaf: testing them costs about as much as one more box
constexpr std::size_t kDepth = 64;  // halving 2^32 polygons needs 32
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
    throw Error("the surface " + surface.name + " has fewer than three corners");
  const Vector3d area = area_vector(surface.corners);
  if (!(area.norm() > 1e-12)) throw Error("the surface " + surface.name + " has no area");
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

/// Where the ray enters the box, or infinity if it misses it.
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

}  // namespace

RayCaster::RayCaster(const Scene& scene) {
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const auto& surface = scene.surfaces[i];
    Polygon polygon{.surface = static_cast<std::uint32_t>(i),
                    .normal = checked_normal(surface),
                    .offset = 0,
                    .axis_u = 0,
                    .axis_v = 0,
                    .outline = {},
                    .corners = surface.corners};
    polygon.offset = polygon.normal.dot(surface.corners.front());
    int steepest = 0;
    polygon.normal.cwiseAbs().maxCoeff(&steepest);
    polygon.axis_u = (steepest + 1) % 3;
    polygon.axis_v = (steepest + 2) % 3;
    for (const auto& c : surface.corners) polygon.outline.emplace_back(c[polygon.axis_u], c[polygon.axis_v]);
    polygons_.push_back(std::move(polygon));
  }
  if (!polygons_.empty()) split(0, static_cast<std::uint32_t>(polygons_.size()));
}

void RayCaster::split(std::uint32_t begin, std::uint32_t end) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d centres;
  const auto centre = [](const Polygon& polygon) {
    Eigen::AlignedBox3d around;
    for (const auto& corner : polygon.corners) around.extend(corner);
    return Vector3d(around.center());
  };
  for (auto i = begin; i < end; ++i) {
    for (const auto& corner : polygons_[i].corners) box.extend(corner);
    centres.extend(centre(polygons_[i]));
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
  std::nth_element(polygons_.begin() + begin, polygons_.begin() + middle, polygons_.begin() + end,
                   [&](const auto& a, const auto& b) { return centre(a)[axis] < centre(b)[axis]; });
  split(begin, middle);
  nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
  split(middle, end);
}

bool RayCaster::covers(const Polygon& polygon, const Vector3d& point) {
  const double u = point[polygon.axis_u];
  const double v = point[polygon.axis_v];
  bool inside = false;
  for (std::size_t i = 0, j = polygon.outline.size() - 1; i < polygon.outline.size(); j = i++) {
    const auto& a = polygon.outline[i];
    const auto& b = polygon.outline[j];
    if ((a.y() > v) != (b.y() > v) && u < (b.x() - a.x()) * (v - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  return inside;
}

std::optional<Hit> RayCaster::cast(const Ray& ray, double max_distance) const {
  if (nodes_.empty()) return std::nullopt;
  const Vector3d inverse = ray.direction.cwiseInverse();
  Hit nearest{.distance = max_distance};
  bool found = false;
  std::array<std::uint32_t, kDepth> stack{};
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t at = stack[--depth];
    const Node& node = nodes_[at];
    if (entry(node.box, ray, inverse) > nearest.distance) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = at + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Polygon& polygon = polygons_[i];
      const double slope = polygon.normal.dot(ray.direction);
      const double distance = (polygon.offset - polygon.normal.dot(ray.origin)) / slope;
      if (!(distance > kStart && distance <= nearest.distance)) continue;
      if (!covers(polygon, ray.origin + distance * ray.direction)) continue;
      nearest = {.distance = distance, .surface = polygon.surface, .cos_incidence = std::abs(slope)};
      found = true;
    }
  }
  return found ? std::optional(nearest) : std::nullopt;
}

double RayCaster::distance(const Polygon& polygon, const Vector3d& point) {
  const double height = polygon.normal.dot(point) - polygon.offset;
  if (covers(polygon, point - height * polygon.normal)) return std::abs(height);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = polygon.corners.size() - 1; i < polygon.corners.size(); j = i++) {
    nearest = std::min(nearest, distance_to_segment(point, polygon.corners[i], polygon.corners[j]));
  }
  return nearest;
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
      nearest = std::min(nearest, distance(polygons_[i], point));
    }
  }
  return nearest;
}

}  // namespace crisp
