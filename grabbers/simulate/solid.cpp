// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/solid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <crisp/error.hpp>

namespace crisp::simulate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMin = 1e-6;  // [m] the smallest radius and side

template <class... Acts>
struct Overloaded : Acts... {
  using Acts::operator()...;
};
template <class... Acts>
Overloaded(Acts...) -> Overloaded<Acts...>;  // clang 14 does not find it out by itself

Vector3d turned(const Vector3d& point, double yaw) {
  Vector3d result = point;
  result.head<2>() = Eigen::Rotation2Dd(yaw) * point.head<2>();
  return result;
}

/// Interval of s with a s² + 2 b s + c ≤ 0, a > 0.
std::optional<Passage> roots(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0)) return std::nullopt;
  // The root without cancellation first (Press et al., Numerical Recipes, 5.6).
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const double one = q / a;
  const double other = q != 0 ? c / q : one;
  return Passage{.in = std::min(one, other), .out = std::max(one, other)};
}

std::optional<Passage> both(const std::optional<Passage>& a, const std::optional<Passage>& b) {
  if (!a || !b) return std::nullopt;
  const Passage common{.in = std::max(a->in, b->in), .out = std::min(a->out, b->out)};
  return common.in < common.out ? std::optional(common) : std::nullopt;
}

/// Interval in which a line with this start and rate lies between two values.
std::optional<Passage> between(double low, double high, double start, double rate) {
  constexpr double kEver = std::numeric_limits<double>::infinity();
  if (rate == 0) {
    return start >= low && start <= high ? std::optional(Passage{.in = -kEver, .out = kEver}) : std::nullopt;
  }
  const double a = (low - start) / rate;
  const double b = (high - start) / rate;
  return Passage{.in = std::min(a, b), .out = std::max(a, b)};
}

/// A cylinder's own coordinates: along its axis from one end, and away from it.
struct Around {
  explicit Around(const Cylinder& c)
      : from(c.from), axis((c.to - c.from).normalized()), length((c.to - c.from).norm()) {}
  double along(const Vector3d& point) const { return axis.dot(point - from); }
  Vector3d across(const Vector3d& v) const { return v - axis.dot(v) * axis; }

  Vector3d from;
  Vector3d axis;
  double length;
};

std::optional<Passage> through(const Cylinder& c, const Ray& ray) {
  const Around own(c);
  const Vector3d start = own.across(ray.origin - c.from);
  const Vector3d rate = own.across(ray.direction);
  const auto ends = between(0, own.length, own.along(ray.origin), own.axis.dot(ray.direction));
  const double slope = rate.squaredNorm();
  if (slope < 1e-24) return start.norm() < c.radius ? ends : std::nullopt;
  return both(ends, roots(slope, rate.dot(start), start.squaredNorm() - c.radius * c.radius));
}

std::optional<Passage> through(const Ellipsoid& e, const Ray& ray) {
  const Vector3d start = turned(ray.origin - e.middle, -e.yaw).cwiseQuotient(e.radii);
  const Vector3d rate = turned(ray.direction, -e.yaw).cwiseQuotient(e.radii);
  return roots(rate.squaredNorm(), rate.dot(start), start.squaredNorm() - 1);
}

std::optional<Passage> through(const Block& b, const Ray& ray) {
  const Vector3d start = turned(ray.origin - b.middle, -b.yaw);
  const Vector3d rate = turned(ray.direction, -b.yaw);
  auto inside = between(-b.half.x(), b.half.x(), start.x(), rate.x());
  inside = both(inside, between(-b.half.y(), b.half.y(), start.y(), rate.y()));
  return both(inside, between(-b.half.z(), b.half.z(), start.z(), rate.z()));
}

/// For a shape that is a product of intervals: the distance of each coordinate from its interval's border,
/// positive outside.
template <int N>
double from_product(const Eigen::Matrix<double, N, 1>& off) {
  return off.maxCoeff() <= 0 ? -off.maxCoeff() : off.cwiseMax(0).norm();
}

double apart(const Cylinder& c, const Vector3d& point) {
  const Around own(c);
  const double along = own.along(point);
  return from_product<2>(
      {std::max(-along, along - own.length), own.across(point - c.from).norm() - c.radius});
}

double apart(const Block& b, const Vector3d& point) {
  return from_product<3>(turned(point - b.middle, -b.yaw).cwiseAbs() - b.half);
}

/// The nearest point x of the surface has x = p r² / (r² + t), with t the largest root of |x / r|² = 1
/// (Eberly, "Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid").
double apart(const Ellipsoid& e, const Vector3d& point) {
  const Vector3d p = turned(point - e.middle, -e.yaw).cwiseAbs();
  const Vector3d squares = e.radii.cwiseAbs2();
  const auto nearest = [&](double t) -> Vector3d {
    return p.cwiseProduct(squares).array() / (squares.array() + t);
  };
  double low = -squares.minCoeff();
  double high = p.cwiseProduct(e.radii).norm();
  constexpr int kHalvings = 200;  // until the doubles are neighbours
  for (int i = 0; i < kHalvings && low < high; ++i) {
    const double t = (low + high) / 2;
    if (t <= low || t >= high) break;
    (nearest(t).cwiseQuotient(e.radii).squaredNorm() > 1 ? low : high) = t;
  }
  Vector3d x = nearest(high);
  // On the plane of symmetry inside, the shortest axis is free to make up what is missing.
  int shortest = 0;
  e.radii.minCoeff(&shortest);
  const double rest =
      1 - (x.cwiseQuotient(e.radii).squaredNorm() - std::pow(x[shortest] / e.radii[shortest], 2));
  if (rest > 0) x[shortest] = e.radii[shortest] * std::sqrt(rest);
  return (x - p).norm();
}

}  // namespace

std::optional<Passage> passage(const Solid& solid, const Ray& ray) {
  return std::visit([&](const auto& shape) { return through(shape, ray); }, solid);
}

Vector3d normal_at(const Solid& solid, const Vector3d& point) {
  const Overloaded act{[&](const Cylinder& c) -> Vector3d {
                         const Around own(c);
                         const double along = own.along(point);
                         const Vector3d away = own.across(point - c.from);
                         const double off_side = std::abs(away.norm() - c.radius);
                         if (off_side <= std::min(std::abs(along), std::abs(along - own.length)))
                           return away.normalized();
                         return along < own.length / 2 ? Vector3d(-own.axis) : own.axis;
                       },
                       [&](const Ellipsoid& e) -> Vector3d {
                         const Vector3d gradient =
                             turned(point - e.middle, -e.yaw).cwiseQuotient(e.radii.cwiseAbs2());
                         return turned(gradient, e.yaw).normalized();
                       },
                       [&](const Block& b) -> Vector3d {
                         const Vector3d own = turned(point - b.middle, -b.yaw);
                         int axis = 0;
                         (own.cwiseAbs() - b.half).maxCoeff(&axis);
                         return turned(std::copysign(1.0, own[axis]) * Vector3d::Unit(axis), b.yaw);
                       }};
  return std::visit(act, solid);
}

double distance_to_surface(const Solid& solid, const Vector3d& point) {
  return std::visit([&](const auto& shape) { return apart(shape, point); }, solid);
}

bool is_inside(const Solid& solid, const Vector3d& point) {
  const auto along_any = passage(solid, {.origin = point, .direction = Vector3d::UnitX()});
  return along_any && along_any->in <= 0 && along_any->out >= 0;
}

Eigen::AlignedBox3d bounds(const Solid& solid) {
  // Half of the extent along x, y and z of what is turned by `yaw`, round or not.
  const Overloaded act{[](const Cylinder& c) {
                         const Vector3d axis = (c.to - c.from).normalized();
                         const Vector3d rim = c.radius * (1 - axis.array().square()).max(0).sqrt();
                         return Eigen::AlignedBox3d(c.from.cwiseMin(c.to) - rim, c.from.cwiseMax(c.to) + rim);
                       },
                       [](const Ellipsoid& e) {
                         const Vector2d x(std::cos(e.yaw) * e.radii.x(), std::sin(e.yaw) * e.radii.y());
                         const Vector2d y(std::sin(e.yaw) * e.radii.x(), std::cos(e.yaw) * e.radii.y());
                         const Vector3d half(x.norm(), y.norm(), e.radii.z());
                         return Eigen::AlignedBox3d(e.middle - half, e.middle + half);
                       },
                       [](const Block& b) {
                         const double c = std::abs(std::cos(b.yaw));
                         const double s = std::abs(std::sin(b.yaw));
                         const Vector3d half(c * b.half.x() + s * b.half.y(), s * b.half.x() + c * b.half.y(),
                                             b.half.z());
                         return Eigen::AlignedBox3d(b.middle - half, b.middle + half);
                       }};
  return std::visit(act, solid);
}

Solid placed(const Solid& solid, double yaw, const Vector3d& by, double scale) {
  const auto to = [&](const Vector3d& point) -> Vector3d { return scale * turned(point, yaw) + by; };
  const Overloaded act{[&](const Cylinder& c) -> Solid {
                         return Cylinder{.from = to(c.from), .to = to(c.to), .radius = scale * c.radius};
                       },
                       [&](const Ellipsoid& e) -> Solid {
                         return Ellipsoid{
                             .middle = to(e.middle), .radii = scale * e.radii, .yaw = e.yaw + yaw};
                       },
                       [&](const Block& b) -> Solid {
                         return Block{.middle = to(b.middle), .half = scale * b.half, .yaw = b.yaw + yaw};
                       }};
  return std::visit(act, solid);
}

void check(const Solid& solid, const std::string& name) {
  const Overloaded least{[](const Cylinder& c) { return std::min(c.radius, (c.to - c.from).norm()); },
                         [](const Ellipsoid& e) { return e.radii.minCoeff(); },
                         [](const Block& b) { return b.half.minCoeff(); }};
  if (!(std::visit(least, solid) >= kMin)) {
    throw Error("the body " + name + " has no volume", "its radii and sides must be more than a micrometre");
  }
}

}  // namespace crisp::simulate
