// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "grabbers/simulate/scene.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {

/// First intersection of a ray with the scene.
struct Hit {
  double distance = 0;        ///< [m] along the ray
  std::uint32_t surface = 0;  ///< index of the thing: of Scene::surfaces and, after them, Scene::bodies
  double cos_incidence =
      0;  ///< |cos β| between the ray and the surface's normal; of foliage one half, its mean
};

/// Data that differ from one shot of a beam to the next.
struct Shot {
  double time = 0;  ///< [s] true time, for what moves
  statistics::RandomStream* chance =
      nullptr;  ///< draws how far the beam gets into foliage; none: as far as in the mean
};

/// Answers what a ray hits and how far a point is from the surfaces, by a tree of bounding boxes.
class RayCaster {
 public:
  /// @throws Error for a surface that is not a flat polygon with an area, or a body without volume
  explicit RayCaster(const Scene& scene);

  /// The first thing that the ray meets within `max_distance` [m], or nothing.
  std::optional<Hit> cast(const Ray& ray, double max_distance, const Shot& shot = {}) const;

  /// Distance [m] of a point to the nearest surface of what stands still; 0 in foliage. Infinite in an empty
  /// scene.
  double distance(const Eigen::Vector3d& point) const;

 private:
  struct Polygon {
    explicit Polygon(const Surface& surface);
    bool covers(const Eigen::Vector3d& point) const;
    std::optional<Hit> cast(const Ray& ray, double within) const;
    double distance(const Eigen::Vector3d& point) const;
    Eigen::AlignedBox3d bounds() const;

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
        0;  ///< leaf: first of order_; otherwise the right child (the left one follows the node)
    std::uint32_t count = 0;  ///< things of a leaf; 0 of an inner node
  };

  void split(std::uint32_t begin, std::uint32_t end, const std::vector<Eigen::AlignedBox3d>& bounds);
  std::optional<Hit> cast_at(std::uint32_t thing, const Ray& ray, double within, const Shot& shot) const;
  double distance_to(std::uint32_t thing, const Eigen::Vector3d& point) const;

  std::vector<Polygon> polygons_;
  std::vector<Body> bodies_;
  std::vector<std::uint32_t> order_;   ///< things that stand still, as the tree has them
  std::vector<std::uint32_t> moving_;  ///< the others
  std::vector<Node> nodes_;
};

}  // namespace crisp::simulate
