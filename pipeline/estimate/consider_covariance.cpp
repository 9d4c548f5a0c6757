// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/consider_covariance.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp::estimate {

ConsiderCovariance consider(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& information,
                            const std::vector<std::string>& names, const Eigen::VectorXd& prior) {
  constexpr double kMore = 4;  // a variance from the held parameters of so many times that from the data
  constexpr double kTakesPart = 0.05;  // of the largest size
  const Eigen::Index m = covariance.rows();
  const Eigen::Index h = prior.size();
  Eigen::MatrixXd slopes = -statistics::solve_positive_definite(
      Eigen::MatrixXd(information.topLeftCorner(m, m)), Eigen::MatrixXd(information.topRightCorner(m, h)));
  // Slopes far below the largest, in standard errors, come from the encoder's steps, which make rates noisy.
  const Eigen::ArrayXXd sizes =
      (information.diagonal().head(m).cwiseSqrt().asDiagonal() * slopes).array().abs();
  for (Eigen::Index j = 0; j < h; ++j) {
    slopes.col(j) = (sizes.col(j) >= kTakesPart * sizes.col(j).maxCoeff()).select(slopes.col(j), 0);
  }
  const Eigen::MatrixXd moves = slopes * prior.asDiagonal();
  ConsiderCovariance result{.covariance = covariance + moves * moves.transpose(), .dependent = {}};
  for (Eigen::Index k = 0; k < m; ++k) {
    if (moves.row(k).squaredNorm() <= kMore * covariance(k, k)) continue;
    std::string combination = names[static_cast<std::size_t>(k)];
    for (Eigen::Index j = 0; j < h; ++j) {
      if (slopes(k, j) == 0) continue;
      combination += fmt::format(" {} {:.4g} * {}", slopes(k, j) > 0 ? "-" : "+", std::abs(slopes(k, j)),
                                 names[static_cast<std::size_t>(m + j)]);
    }
    result.dependent.push_back({.parameter = names[static_cast<std::size_t>(k)],
                                .reason = "its estimate is conditional on assumed values of other parameters",
                                .combination = std::move(combination)});
  }
  return result;
}

}  // namespace crisp::estimate
