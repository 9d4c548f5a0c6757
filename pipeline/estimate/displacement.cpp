// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/displacement.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>

namespace crisp::estimate {
namespace {

/// A shift and a small turn of everything move a point x by MΘ, M = [I, −[x]×]: the sum of all MᵀM.
class RigidMotions {
 public:
  void add(const Eigen::Vector3d& x) {
    ++points_;
    sum_ += x;
    squares_ += x * x.transpose();
  }
  Eigen::Matrix<double, 6, 6> gram() const {
    Eigen::Matrix3d turn;
    turn << 0, sum_.z(), -sum_.y(), -sum_.z(), 0, sum_.x(), sum_.y(), -sum_.x(), 0;
    Eigen::Matrix<double, 6, 6> all;
    all << Eigen::Matrix3d::Identity() * points_, turn, turn.transpose(),
        Eigen::Matrix3d::Identity() * squares_.trace() - squares_;
    return all;
  }

 private:
  double points_ = 0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
};

}  // namespace

Eigen::MatrixXd displacement(const SensorModel& model, const Sample& sample,
                             const std::vector<std::size_t>& free) {
  PointDerivatives derivatives;
  const Placed placed = model.place(sample.beams, *sample.plate, free, derivatives);
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(6, n);
  RigidMotions motions;
  for (std::size_t i = 0; i < placed.index.size(); ++i) {
    const Eigen::Vector3d point = placed.points.col(static_cast<Eigen::Index>(i));
    const auto& columns = derivatives.columns[sample.beams.laser[placed.index[i]]];
    const auto first = static_cast<Eigen::Index>(i * derivatives.stride);
    motions.add(point);
    for (std::size_t a = 0; a < columns.size(); ++a) {
      const auto column = static_cast<Eigen::Index>(columns[a]);
      const Eigen::Vector3d step = derivatives.values.col(first + static_cast<Eigen::Index>(a));
      mixed.col(column).head<3>() += step;
      mixed.col(column).tail<3>() += point.cross(step);
      for (std::size_t b = 0; b < columns.size(); ++b) {
        own(column, static_cast<Eigen::Index>(columns[b])) +=
            step.dot(derivatives.values.col(first + static_cast<Eigen::Index>(b)));
      }
    }
  }
  const Eigen::Matrix<double, 6, 6> rigid =
      motions.gram() + Eigen::Matrix<double, 6, 6>::Identity() * 1e-9;  // points may all coincide
  own -= mixed.transpose() * rigid.ldlt().solve(mixed);
  return own / static_cast<double>(std::max<std::size_t>(1, placed.index.size()));
}

}  // namespace crisp::estimate
