// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/plane.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace crisp::quality {
namespace {

constexpr double kTilt = 0.05;  // [rad] of a view's own plane: what a wrong calibration may do

/// The normal equations of a view's own plane, with a prior on its tilt.
Eigen::LDLT<Eigen::Matrix3d> damped(Eigen::Matrix3d matrix) {
  matrix.diagonal() += Eigen::Vector3d(1e-9 * matrix(0, 0), 1 / (kTilt * kTilt), 1 / (kTilt * kTilt));
  return matrix.ldlt();
}

}  // namespace

Moments& Moments::operator+=(const Moments& other) {
  count += other.count;
  sum += other.sum;
  squares += other.squares;
  return *this;
}

Plane plane_of(const Moments& moments) {
  Plane plane;
  if (moments.count == 0) return plane;
  plane.middle = moments.sum / moments.count;
  const Eigen::Matrix3d covariance =
      moments.squares / moments.count - plane.middle * plane.middle.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  plane.normal = axes.eigenvectors().col(0);
  plane.v = axes.eigenvectors().col(1);
  plane.u = axes.eigenvectors().col(2);
  plane.extent = axes.eigenvalues().cwiseMax(0).cwiseSqrt();
  return plane;
}

ViewSums ViewSums::of(const Moments& weighted, double count, const Plane& plane) {
  const Eigen::Vector3d& middle = plane.middle;
  const Eigen::Vector3d sum = weighted.sum - weighted.count * middle;
  const Eigen::Matrix3d squares = weighted.squares - weighted.sum * middle.transpose() -
                                  middle * weighted.sum.transpose() +
                                  weighted.count * middle * middle.transpose();
  ViewSums sums;
  sums.count_ = count;
  sums.weight_ = weighted.count;
  sums.u_ = plane.u.dot(sum);
  sums.v_ = plane.v.dot(sum);
  sums.distance_ = plane.normal.dot(sum);
  sums.uu_ = plane.u.dot(squares * plane.u);
  sums.uv_ = plane.u.dot(squares * plane.v);
  sums.vv_ = plane.v.dot(squares * plane.v);
  sums.u_distance_ = plane.u.dot(squares * plane.normal);
  sums.v_distance_ = plane.v.dot(squares * plane.normal);
  sums.squares_ = plane.normal.dot(squares * plane.normal);
  return sums;
}

ViewSums& ViewSums::operator+=(const ViewSums& other) {
  count_ += other.count_;
  weight_ += other.weight_;
  u_ += other.u_;
  v_ += other.v_;
  distance_ += other.distance_;
  uu_ += other.uu_;
  uv_ += other.uv_;
  vv_ += other.vv_;
  u_distance_ += other.u_distance_;
  v_distance_ += other.v_distance_;
  squares_ += other.squares_;
  return *this;
}

Eigen::Matrix3d ViewSums::matrix() const {
  Eigen::Matrix3d matrix;
  matrix << weight_, u_, v_, u_, uu_, uv_, v_, uv_, vv_;
  return matrix;
}

Eigen::Vector3d ViewSums::vector() const { return {distance_, u_distance_, v_distance_}; }

Eigen::Vector3d ViewSums::fit() const { return damped(matrix()).solve(vector()); }

double ViewSums::squares_left(const Eigen::Vector3d& fit) const {
  return squares_ - 2 * fit.dot(vector()) + fit.dot(matrix() * fit) +
         fit.tail<2>().squaredNorm() / (kTilt * kTilt);
}

double ViewSums::degrees_of_freedom() const { return count_ - damped(matrix()).solve(matrix()).trace(); }

}  // namespace crisp::quality
