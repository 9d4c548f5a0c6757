// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/permutation_test.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "pipeline/clocks/series.hpp"
#include "pipeline/statistics/bootstrap.hpp"
#include "pipeline/statistics/dense_solvers.hpp"
#include "pipeline/statistics/monte_carlo_test.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::diagnose {
namespace {

Eigen::MatrixXd given(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd both(columns.rows(), base.cols() + columns.cols());
  both.leftCols(base.cols()) = base;
  both.rightCols(columns.cols()) = columns;
  return both;
}

/// Residuals of every other value about a fit to the rest.
std::vector<double> left_of_others(const Eigen::MatrixXd& design, const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> fitted;
  std::vector<Eigen::Index> rest;
  for (Eigen::Index w = 0; w < values.size(); ++w) (w % 2 == 0 ? fitted : rest).push_back(w);
  Eigen::VectorXd left = values(rest);
  if (design.cols() > 0) {
    const Eigen::MatrixXd some = design(fitted, Eigen::all);
    left -= design(rest, Eigen::all) * statistics::least_squares(some, values(fitted));
  }
  return {left.begin(), left.end()};
}

}  // namespace

double bic_of_series(double squares, Eigen::Index n, double parameters) {
  const auto values = static_cast<double>(n);
  return values * std::log(std::max(squares, std::numeric_limits<double>::min()) / values) +
         parameters * std::log(values);
}

Gain gain_in_series(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                    const Eigen::VectorXd& values, std::uint64_t seed) {
  constexpr std::size_t kDraws = 999;
  const auto before = left_of_others(base, values);
  const auto after = left_of_others(given(base, columns), values);
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
          .ci95 = statistics::bootstrap(before.size(), 1, seed, kDraws, change).ci95};
}

PermutationTest test_series(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                            const Eigen::VectorXd& values, std::uint64_t seed) {
  constexpr std::size_t kShuffles = 4999;
  const clocks::SeriesFit fit = clocks::best_in_series(base, columns, values);
  PermutationTest test{.column = fit.column,
                       .values = fit.values,
                       .errors = fit.errors,
                       .gain = gain_in_series(base, columns.col(fit.column), values, seed)};
  // All permutations have the same sum of squares, so the largest inner product decides.
  const Eigen::MatrixXd unit = clocks::off_base(base, columns).colwise().normalized();
  Eigen::VectorXd left = clocks::off_base(base, values);
  statistics::RandomStream random(seed, "permutations");
  const auto permuted = [&] {
    random.shuffle(left);
    return (unit.transpose() * left).cwiseAbs().maxCoeff();
  };
  test.p_value = statistics::monte_carlo_test(fit.product, kShuffles, permuted).p_value;
  return test;
}

}  // namespace crisp::diagnose
