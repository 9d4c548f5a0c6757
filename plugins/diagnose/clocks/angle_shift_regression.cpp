// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/angle_shift_regression.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "pipeline/data/degree.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

double signed_square(double rate) { return rate * std::abs(rate); }
double sign_of(double rate) { return rate > 0 ? 1 : rate < 0 ? -1 : 0; }

}  // namespace

std::int64_t AngleShiftModel::block_of(double time) {
  return static_cast<std::int64_t>(std::floor(time / kBlock));
}

AngleShiftModel::AngleShiftModel(std::span<const AngleShift> shifts, std::vector<double> times)
    : shifts_(shifts), times_(std::move(times)) {
  std::size_t lasers = 0;
  for (const AngleShift& shift : shifts) lasers = std::max(lasers, shift.laser + 1);
  nuisances_ = lasers + 2;
  fit();
}

void AngleShiftModel::add(double time) {
  times_.push_back(time);
  fit();
}

void AngleShiftModel::remove(std::size_t step) {
  times_.erase(times_.begin() + static_cast<std::ptrdiff_t>(step));
  fit();
}

double AngleShiftModel::size(std::size_t step) const { return solution_[column(step)]; }

double AngleShiftModel::std_error(std::size_t step) const {
  const double variance = covariance_(column(step), column(step));
  return variance > 0 ? std::sqrt(variance) : std::numeric_limits<double>::infinity();
}

Eigen::VectorXd AngleShiftModel::row(const AngleShift& shift) const {
  Eigen::VectorXd row = Eigen::VectorXd::Zero(column(times_.size()));
  row[static_cast<Eigen::Index>(shift.laser)] = shift.rate_later - shift.rate_earlier;
  row[column(0) - 2] = signed_square(shift.rate_later) - signed_square(shift.rate_earlier);
  row[column(0) - 1] = sign_of(shift.rate_later) - sign_of(shift.rate_earlier);
  for (std::size_t k = 0; k < times_.size(); ++k) row[column(k)] = is_across(shift, times_[k]) ? 1 : 0;
  return row;
}

void AngleShiftModel::fit() {
  constexpr int kRounds = 12;
  constexpr double kHuber = 1.5;
  constexpr double kPrior = 1e-9;  // ridge that keeps unobservable parameters at 0
  const auto n = static_cast<Eigen::Index>(shifts_.size());
  const Eigen::Index m = column(times_.size());
  Eigen::MatrixXd rows(n, m);
  Eigen::VectorXd values(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    rows.row(i) = row(shifts_[static_cast<std::size_t>(i)]);
    values[i] = shifts_[static_cast<std::size_t>(i)].shift;
  }
  weights_ = Eigen::VectorXd::Ones(n);
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::MatrixXd weighted = weights_.asDiagonal() * rows;
    const Eigen::MatrixXd normal = rows.transpose() * weighted + kPrior * Eigen::MatrixXd::Identity(m, m);
    inverse_ = normal.ldlt().solve(Eigen::MatrixXd::Identity(m, m));
    solution_ = inverse_ * (weighted.transpose() * values);
    residuals_ = values - rows * solution_;
    const double limit = kHuber * scale();
    for (Eigen::Index i = 0; i < n; ++i) weights_[i] = std::min(1.0, limit / std::abs(residuals_[i]));
  }
  covariance_ = inverse_ * clustered_scores(rows) * inverse_;
}

std::vector<AngleShiftModel::StepScore> AngleShiftModel::step_scores() const {
  constexpr double kLeft = 0.01;  // share of a step's squares that the other parameters must not absorb
  struct Sums {
    double gradient = 0;
    double weight = 0;
    Eigen::VectorXd cross;  // with the other parameters
  };
  const Sums none{.cross = Eigen::VectorXd::Zero(column(times_.size()))};
  const auto add = [](Sums& to, double sign, const Sums& other) {
    to.gradient += sign * other.gradient;
    to.weight += sign * other.weight;
    to.cross += sign * other.cross;
  };
  std::map<std::int64_t, Sums> changes;  // of the sums from one block to the next
  for (std::size_t i = 0; i < shifts_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const Sums own{.gradient = weights_[k] * residuals_[k],
                   .weight = weights_[k],
                   .cross = weights_[k] * row(shifts_[i])};
    add(changes.try_emplace(block_of(shifts_[i].earlier) + 1, none).first->second, 1, own);
    add(changes.try_emplace(block_of(shifts_[i].later) + 1, none).first->second, -1, own);
  }
  std::vector<StepScore> scores;
  Sums sum = none;
  for (const auto& [block, change] : changes) {
    add(sum, 1, change);
    const double left = sum.weight - sum.cross.dot(inverse_ * sum.cross);
    if (!(left > kLeft * sum.weight)) continue;
    scores.push_back({.block = block, .gain = sum.gradient * sum.gradient / left, .shifts = sum.weight});
  }
  return scores;
}

Eigen::MatrixXd AngleShiftModel::clustered_scores(const Eigen::MatrixXd& rows) const {
  std::map<std::int64_t, Eigen::VectorXd> scores;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const double later = shifts_[static_cast<std::size_t>(i)].later;
    auto& score = scores.try_emplace(block_of(later), Eigen::VectorXd::Zero(rows.cols())).first->second;
    score += weights_[i] * residuals_[i] * rows.row(i).transpose();
  }
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows.cols(), rows.cols());
  for (const auto& [block, score] : scores) sum += score * score.transpose();
  return sum;
}

double AngleShiftModel::scale() const {
  constexpr double kMin = 0.01 * data::kDegree;
  std::vector<double> sizes(static_cast<std::size_t>(residuals_.size()));
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    sizes[i] = std::abs(residuals_[static_cast<Eigen::Index>(i)]);
  }
  return std::max(kMin, statistics::kMadToSigma * statistics::median_in_place(sizes));
}

}  // namespace crisp::diagnose
