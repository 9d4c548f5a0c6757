// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/statistics/non_negative_regression.hpp"

#include <Eigen/Cholesky>

namespace crisp::statistics {
namespace {

/// Members of a subset of the coefficients, given as a bit mask.
std::vector<Eigen::Index> members_of(std::size_t set, Eigen::Index count) {
  std::vector<Eigen::Index> members;
  for (Eigen::Index k = 0; k < count; ++k) {
    if ((set >> k & 1U) != 0) members.push_back(k);
  }
  return members;
}

}  // namespace

NonNegativeProblem::NonNegativeProblem(std::size_t coefficients)
    : normal_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(coefficients),
                                    static_cast<Eigen::Index>(coefficients))),
      right_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coefficients))) {}

void NonNegativeProblem::add(std::span<const double> levers, double value, double weight) {
  for (Eigen::Index row = 0; row < right_.size(); ++row) {
    const double weighted = weight * levers[static_cast<std::size_t>(row)];
    if (weighted == 0) continue;  // most are
    for (Eigen::Index column = 0; column <= row; ++column) {
      normal_(row, column) += weighted * levers[static_cast<std::size_t>(column)];
    }
    right_[row] += weighted * value;
  }
}

void NonNegativeProblem::operator+=(const NonNegativeProblem& other) {
  normal_ += other.normal_;
  right_ += other.right_;
}

std::vector<double> NonNegativeProblem::solution() const {
  constexpr double kIdentified = 1e-9;  // share of a squared regressor that the others leave
  const Eigen::VectorXd unit =
      normal_.diagonal().cwiseSqrt().unaryExpr([](double size) { return size > 0 ? 1 / size : 0; });
  const Eigen::MatrixXd scaled =
      unit.asDiagonal() * Eigen::MatrixXd(normal_.selfadjointView<Eigen::Lower>()) * unit.asDiagonal();
  const Eigen::VectorXd right = unit.cwiseProduct(right_);
  Eigen::VectorXd best = Eigen::VectorXd::Zero(right.size());
  double most = 0;  // largest decrease of the squares
  for (std::size_t set = 1; set < std::size_t{1} << right.size(); ++set) {
    const auto members = members_of(set, right.size());
    const Eigen::LDLT<Eigen::MatrixXd> factors(scaled(members, members));
    if (!(factors.vectorD().minCoeff() > kIdentified)) continue;
    const Eigen::VectorXd found = factors.solve(right(members));
    const double fall = found.dot(right(members));
    if (found.minCoeff() < 0 || fall <= most) continue;
    most = fall;
    best.setZero();
    best(members) = found;
  }
  best = best.cwiseProduct(unit);
  return {best.begin(), best.end()};
}

}  // namespace crisp::statistics
