// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/series.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "pipeline/quality/resampling.hpp"

namespace crisp {
namespace {

/// What the base leaves of each column.
Eigen::MatrixXd off_base(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd orthonormal =
      base.householderQr().householderQ() * Eigen::MatrixXd::Identity(base.rows(), base.cols());
  return columns - orthonormal * (orthonormal.transpose() * columns);
}

struct Fit {
  Eigen::VectorXd values;
  Eigen::VectorXd errors;
};

Fit least_squares(const Eigen::MatrixXd& design, const Eigen::VectorXd& values) {
  const auto solver = design.colPivHouseholderQr();
  Fit fit{.values = solver.solve(values), .errors = {}};
  const double squares = (values - design * fit.values).squaredNorm();
  const double variance =
      squares / static_cast<double>(std::max<Eigen::Index>(1, design.rows() - design.cols()));
  fit.errors = (variance * (design.transpose() * design).inverse().diagonal()).cwiseSqrt();
  return fit;
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& base, const Eigen::VectorXd& column) {
  Eigen::MatrixXd both(base.rows(), base.cols() + 1);
  both << base, column;
  return both;
}

/// Every other value about a fit to the rest.
std::vector<double> left_of_others(const Eigen::MatrixXd& design, const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> fitted;
  std::vector<Eigen::Index> rest;
  for (Eigen::Index w = 0; w < values.size(); ++w) (w % 2 == 0 ? fitted : rest).push_back(w);
  const Fit fit = least_squares(design(fitted, Eigen::all), values(fitted));
  const Eigen::VectorXd left = values(rest) - design(rest, Eigen::all) * fit.values;
  return {left.begin(), left.end()};
}

Gain gain_of(const Eigen::MatrixXd& base, const Eigen::VectorXd& column, const Eigen::VectorXd& values,
             std::uint64_t seed) {
  constexpr std::size_t kDraws = 999;
  const auto before = left_of_others(base, values);
  const auto after = left_of_others(beside(base, column), values);
  const auto rms = [](const std::vector<double>& all, const std::vector<std::size_t>& drawn) {
    double squares = 0;
    for (const std::size_t i : drawn) squares += all[i] * all[i];
    return std::sqrt(squares / static_cast<double>(drawn.size()));
  };
  std::vector<std::size_t> all(before.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto change = [&](const std::vector<std::size_t>& drawn) {
    return rms(after, drawn) - rms(before, drawn);
  };
  return {.metric = {},
          .unit = {},
          .before = rms(before, all),
          .after = rms(after, all),
          .ci95 = bootstrap(before.size(), 1, seed, kDraws, change).ci95};
}

}  // namespace

SeriesLook look_at_series(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                          const Eigen::VectorXd& values, std::uint64_t seed) {
  constexpr int kShuffles = 4999;
  const Eigen::MatrixXd unit = off_base(base, columns).colwise().normalized();
  Eigen::VectorXd left = off_base(base, values);
  SeriesLook look;
  // All shuffles have the same sum of squares: the largest product alone says which does best.
  const double best = (unit.transpose() * left).cwiseAbs().maxCoeff(&look.column);
  const Fit fit = least_squares(beside(base, columns.col(look.column)), values);
  look.values = fit.values;
  look.errors = fit.errors;
  look.gain = gain_of(base, columns.col(look.column), values, seed);
  std::mt19937_64 random(seed);
  int above = 0;
  for (int s = 0; s < kShuffles; ++s) {
    std::ranges::shuffle(left, random);
    above += (unit.transpose() * left).cwiseAbs().maxCoeff() >= best ? 1 : 0;
  }
  look.p_value = (1.0 + above) / (1.0 + kShuffles);
  return look;
}

Eigen::MatrixXd steps(Eigen::Index n, Eigen::Index margin) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, std::max<Eigen::Index>(0, n - 2 * margin + 1));
  for (Eigen::Index k = 0; k < columns.cols(); ++k) columns.col(k).tail(n - margin - k).setOnes();
  return columns;
}

Eigen::Index before_step(const Eigen::VectorXd& column) { return (column.array() == 0).count(); }

}  // namespace crisp
