// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace independent {

struct Vector {
  double x = 0, y = 0, z = 0;
};
inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(double s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double norm(Vector a) { return std::sqrt(dot(a, a)); }
inline Vector cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Three orthonormal vectors, right-handed.
struct Axes {
  Vector x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};
Axes turned_about_vertical(double yaw);  ///< [rad]
Axes rotated(Axes axes, Vector unit,
             double by);  ///< every axis turned by `by` [rad] about `unit` (Rodrigues)

enum class Form { box, cylinder, ellipsoid };

/// A solid of the scene; lengths in m. A room is a box seen from inside.
struct Solid {
  Form form = Form::box;
  Vector center;
  Axes axes;
  Vector half;  ///< half extents along the axes; a cylinder's axis is z, its radius half.x = half.y
  double reflectivity = 0.5;
};

struct Hit {
  double range = 0;      ///< [m]
  double incidence = 0;  ///< cosine of the angle between beam and surface normal
  double reflectivity = 0;
};

class World {
 public:
  void add(Solid solid);
  /// First surface along a ray; nothing where the ray leaves the scene.
  std::optional<Hit> cast(Vector origin, Vector direction) const;

 private:
  std::vector<Solid> solids_;
  std::vector<double> bounds_;  ///< radii of the solids' bounding spheres [m]
};

/// Shortest distance from a point to the box that encloses a solid, 0 inside [m].
double clearance(const Solid& solid, Vector point);

/// Builds a scene by name: office, hall, street, tunnel or workshop.
///
/// The scanner stands at (0, 0, height); ground at z = 0; no solid comes closer to the scanner than 0.85 m.
World build_scene(const std::string& name, double height, std::mt19937_64 random);

}  // namespace independent
