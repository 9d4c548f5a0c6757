// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "grabbers/simulate/scene.hpp"

namespace crisp {

struct Ray {
  Eigen::Vector3d origin;     ///< [m]
  Eigen::Vector3d direction;  ///< unit vector
};

/// Where a ray first meets the scene.
struct Hit {
  double distance = 0;        ///< [m] along the ray
  std::uint32_t surface = 0;  ///< index into Scene::surfaces
  double cos_incidence = 0;   ///< |cos β| between the ray and the surface's normal
};

/// Answers what a ray hits and how far a point is from the surfaces, by a tree of bounding boxes.
class RayCaster {
 public:
  /// @throws Error for a surface that is not a flat polygon with an area
  explicit RayCaster(const Scene& scene);

  /// The first surface that the ray meets within `max_distance` [m], or nothing.
  std::optional<Hit> cast(const Ray& ray, double max_distance) const;

  /// Distance [m] of a point to the nearest surface; infinite in an empty scene.
  double distance(const Eigen::Vector3d& point) const;

 private:
  struct Polygon {
    std::uint32_t surface;
    Eigen::Vector3d normal;
    double offset;  ///< normal · x of its points
    int axis_u;     ///< the two axes that it is drawn in: the normal leans on the third
    int axis_v;
    std::vector<Eigen::Vector2d> outline;
    std::vector<Eigen::Vector3d> corners;
  };
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first =
        0;  ///< leaf: first polygon; otherwise the right child (the left one follows the node)
    std::uint32_t count = 0;  ///< polygons of a leaf; 0 of an inner node
  };

  void split(std::uint32_t begin, std::uint32_t end);
  static bool covers(const Polygon& polygon, const Eigen::Vector3d& point);
  static double distance(const Polygon& polygon, const Eigen::Vector3d& point);

  std::vector<Polygon> polygons_;
  std::vector<Node> nodes_;
};

}  // namespace crisp
