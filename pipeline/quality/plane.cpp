// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/plane.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace crisp {
namespace {

constexpr double kTilt = 0.05;  // [rad] of a view's own plane: what a wrong calibration may do

/// The normal equations of a view's own plane, with a prior on its tilt.
Eigen::LDLT<Eigen::Matrix3d> damped(const Eigen::Matrix4d& squares) {
  Eigen::Matrix3d matrix = squares.topLeftCorner<3, 3>();
  matrix.diagonal() += Eigen::Vector3d(1e-9 * matrix(0, 0), 1 / (kTilt * kTilt), 1 / (kTilt * kTilt));
  return matrix.ldlt();
}

}  // namespace

void Moments::add(const Eigen::Vector3d& point) {
  count += 1;
  sum += point;
  squares += point * point.transpose();
}

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

void ViewSums::add(double u, double v, double distance, double weight) {
  const Eigen::Vector4d row(1, u, v, distance);
  squares += weight * row * row.transpose();
  count += 1;
}

ViewSums& ViewSums::operator+=(const ViewSums& other) {
  squares += other.squares;
  count += other.count;
  return *this;
}

Eigen::Vector3d ViewSums::fit() const { return damped(squares).solve(squares.topRightCorner<3, 1>()); }

double ViewSums::squares_left(const Eigen::Vector3d& fit) const {
  return squares(3, 3) - 2 * fit.dot(squares.topRightCorner<3, 1>()) +
         fit.dot(squares.topLeftCorner<3, 3>() * fit) + fit.tail<2>().squaredNorm() / (kTilt * kTilt);
}

double ViewSums::freedom() const {
  return count - damped(squares).solve(Eigen::Matrix3d(squares.topLeftCorner<3, 3>())).trace();
}

}  // namespace crisp
