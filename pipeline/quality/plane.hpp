// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace crisp::quality {

/// Sums over points, from which their plane follows; to be added.
struct Moments {
  double count = 0;  ///< or the sum of their weights
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& point, double weight = 1) {
    const Eigen::Vector3d weighted = weight * point;
    count += weight;
    sum += weighted;
    squares += weighted * point.transpose();
  }
  Moments& operator+=(const Moments& other);
};

/// The plane that points lie nearest to, all counting the same.
struct Plane {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d u = Eigen::Vector3d::UnitX();  ///< where the points extend the farthest
  Eigen::Vector3d v = Eigen::Vector3d::UnitY();
  /// [m] standard deviation of the points along the normal, v and u: ascending
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();

  double distance(const Eigen::Vector3d& point) const { return normal.dot(point - middle); }
};

Plane plane_of(const Moments& moments);

/// Sums over one view's beams on a surface, for a plane of its own.
class ViewSums {
 public:
  /// @param u, v, distance  [m] from a common plane
  /// @param weight          [1/m²]; beams of weight 0 are none
  void add(double u, double v, double distance, double weight) {
    const double by_u = weight * u;
    const double by_v = weight * v;
    const double by_distance = weight * distance;
    count_ += weight > 0 ? 1 : 0;
    weight_ += weight;
    u_ += by_u;
    v_ += by_v;
    distance_ += by_distance;
    uu_ += by_u * u;
    uv_ += by_v * u;
    vv_ += by_v * v;
    u_distance_ += by_u * distance;
    v_distance_ += by_v * distance;
    squares_ += by_distance * distance;
  }

  ViewSums& operator+=(const ViewSums& other);

  /// The sums of points with these moments.
  ///
  /// @param weighted  of the points, weighted [1/m²]
  /// @param plane     the common one
  static ViewSums of(const Moments& weighted, double count, const Plane& plane);

  double count() const { return count_; }
  Eigen::Matrix3d matrix() const;  ///< weighted, of the products of 1, u and v
  Eigen::Vector3d vector() const;  ///< and of theirs with the distance

  /// Distance [m] at u = v = 0, and slopes along u and v, of the best-fitting plane. Where beams do not
  /// determine a slope (a single line, a few points), it stays within some degrees of none.
  Eigen::Vector3d fit() const;
  double squares_left(const Eigen::Vector3d& fit) const;  ///< weighted, of residuals and of the tilt
  double degrees_of_freedom() const;                      ///< beams, less what the fit took

 private:
  // Numbers by themselves: of what is summed in a loop all stay in registers.
  double count_ = 0;
  double weight_ = 0, u_ = 0, v_ = 0, distance_ = 0;
  double uu_ = 0, uv_ = 0, vv_ = 0, u_distance_ = 0, v_distance_ = 0, squares_ = 0;
};

}  // namespace crisp::quality
