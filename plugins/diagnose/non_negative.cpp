// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/non_negative.hpp"

#include <Eigen/Cholesky>

namespace crisp {
namespace {

/// The members of one set of coefficients, a bit each.
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
    for (Eigen::Index column = 0; column <= row; ++column) {
      normal_(row, column) += weighted * levers[static_cast<std::size_t>(column)];
    }
    right_[row] += weighted * value;
  }
}

std::vector<double> NonNegativeProblem::solution() const {
  constexpr double kTold = 1e-9;  // of a lever that the others leave, in squares
  const Eigen::VectorXd unit =
      normal_.diagonal().cwiseSqrt().unaryExpr([](double size) { return size > 0 ? 1 / size : 0; });
  const Eigen::MatrixXd scaled =
      unit.asDiagonal() * Eigen::MatrixXd(normal_.selfadjointView<Eigen::Lower>()) * unit.asDiagonal();
  const Eigen::VectorXd right = unit.cwiseProduct(right_);
  Eigen::VectorXd best = Eigen::VectorXd::Zero(right.size());
  double most = 0;  // by which squares fall
  for (std::size_t set = 1; set < std::size_t{1} << right.size(); ++set) {
    const auto members = members_of(set, right.size());
    const Eigen::LDLT<Eigen::MatrixXd> factors(scaled(members, members));
    if (!(factors.vectorD().minCoeff() > kTold)) continue;
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

}  // namespace crisp
