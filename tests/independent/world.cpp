// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/world.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace independent {
namespace {

constexpr double kNearest = 1e-6;  // [m] surfaces nearer than this are the ray's own start

struct Intersection {
  double range;
  Vector normal;  // in the solid's own axes, unit length
};

std::optional<Intersection> intersect_box(Vector o, Vector d, Vector half) {
  const double origin[3] = {o.x, o.y, o.z}, direction[3] = {d.x, d.y, d.z},
               size[3] = {half.x, half.y, half.z};
  double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
  int enter_axis = 0, leave_axis = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(direction[i]) < 1e-14) {
      if (std::abs(origin[i]) > size[i]) return {};
      continue;
    }
    const double middle = -origin[i] / direction[i], span = size[i] / std::abs(direction[i]);
    if (middle - span > enter) enter = middle - span, enter_axis = i;
    if (middle + span < leave) leave = middle + span, leave_axis = i;
  }
  if (enter > leave || leave < kNearest) return {};
  const bool outside = enter > kNearest;
  const int axis = outside ? enter_axis : leave_axis;
  return Intersection{outside ? enter : leave,
                      {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}};
}

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Positive roots of a s² + 2 b s + c = 0, the smaller first; `kNone` for each that does not exist.
std::array<double, 2> positive_roots(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (discriminant < 0 || a < 1e-14) return {kNone, kNone};
  const double root = std::sqrt(discriminant), small = (-b - root) / a, large = (-b + root) / a;
  if (small > kNearest) return {small, large};
  return {large > kNearest ? large : kNone, kNone};
}

std::optional<Intersection> intersect_cylinder(Vector o, Vector d, Vector half) {
  std::optional<Intersection> first;
  const auto keep = [&](double s, Vector normal) {
    if (!first || s < first->range) first = Intersection{s, normal};
  };
  const double r = half.x;
  for (const double s :
       positive_roots(d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y, o.x * o.x + o.y * o.y - r * r)) {
    if (s == kNone) continue;
    const Vector p = o + s * d;
    if (std::abs(p.z) <= half.z) keep(s, {p.x / r, p.y / r, 0});
  }
  for (const double end : {-half.z, half.z}) {
    const double s = (end - o.z) / d.z;
    if (!(s > kNearest)) continue;
    const Vector p = o + s * d;
    if (p.x * p.x + p.y * p.y <= r * r) keep(s, {0, 0, 1});
  }
  return first;
}

std::optional<Intersection> intersect_ellipsoid(Vector o, Vector d, Vector half) {
  const auto scaled = [&](Vector v) { return Vector{v.x / half.x, v.y / half.y, v.z / half.z}; };
  const Vector so = scaled(o), sd = scaled(d);
  const auto roots = positive_roots(dot(sd, sd), dot(so, sd), dot(so, so) - 1);
  if (roots[0] == kNone) return {};
  const Vector normal = scaled(so + roots[0] * sd);
  return Intersection{roots[0], (1 / norm(normal)) * normal};
}

Vector in_axes(const Axes& axes, Vector v) { return {dot(axes.x, v), dot(axes.y, v), dot(axes.z, v)}; }

}  // namespace

Axes turned_about_vertical(double yaw) {
  return {{std::cos(yaw), std::sin(yaw), 0}, {-std::sin(yaw), std::cos(yaw), 0}, {0, 0, 1}};
}

Axes rotated(Axes axes, Vector unit, double by) {
  const double c = std::cos(by), s = std::sin(by);
  const auto rotate = [&](Vector v) { return c * v + s * cross(unit, v) + ((1 - c) * dot(unit, v)) * unit; };
  return {rotate(axes.x), rotate(axes.y), rotate(axes.z)};
}

void World::add(Solid solid) {
  bounds_.push_back(norm(solid.half));
  solids_.push_back(solid);
}

std::optional<Hit> World::cast(Vector origin, Vector direction) const {
  std::optional<Hit> first;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    const Solid& solid = solids_[i];
    const Vector to_center = solid.center - origin;
    const double along = dot(to_center, direction), bound = bounds_[i];
    if (along < -bound || along - bound > nearest) continue;
    if (dot(to_center, to_center) - along * along > bound * bound) continue;
    const Vector o = in_axes(solid.axes, -1.0 * to_center), d = in_axes(solid.axes, direction);
    const auto intersection = solid.form == Form::box        ? intersect_box(o, d, solid.half)
                              : solid.form == Form::cylinder ? intersect_cylinder(o, d, solid.half)
                                                             : intersect_ellipsoid(o, d, solid.half);
    if (!intersection || intersection->range >= nearest) continue;
    nearest = intersection->range;
    first = Hit{nearest, std::abs(dot(intersection->normal, d)), solid.reflectivity};
  }
  return first;
}

double clearance(const Solid& solid, Vector point) {
  const Vector p = in_axes(solid.axes, point - solid.center);
  const auto beyond = [](double value, double half) { return std::max(0.0, std::abs(value) - half); };
  return norm({beyond(p.x, solid.half.x), beyond(p.y, solid.half.y), beyond(p.z, solid.half.z)});
}

}  // namespace independent
