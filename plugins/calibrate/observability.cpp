// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/observability.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace crisp {
namespace {

/// Which kind of parameter is held at its prior first.
int reluctance(const std::string& name) {
  const std::vector<std::string> order = {".eta", ".alpha", ".lambda", ".tau"};
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (name.ends_with(order[i])) return static_cast<int>(i) + 1;
  }
  return 0;  // terms beyond equation (2) go before all of it
}

/// The part of a matrix that belongs to the parameters in `active`.
Eigen::MatrixXd part(const Eigen::MatrixXd& matrix, const std::vector<std::size_t>& active) {
  const auto n = static_cast<Eigen::Index>(active.size());
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      result(i, j) = matrix(static_cast<Eigen::Index>(active[static_cast<std::size_t>(i)]),
                            static_cast<Eigen::Index>(active[static_cast<std::size_t>(j)]));
    }
  }
  return result;
}

}  // namespace

Observability observability(const Eigen::MatrixXd& information, const std::vector<std::size_t>& free,
                            const std::vector<std::string>& names, const Eigen::VectorXd& prior) {
  const Eigen::MatrixXd scaled = prior.asDiagonal() * information * prior.asDiagonal();
  std::vector<std::size_t> active(free.size());
  for (std::size_t i = 0; i < active.size(); ++i) active[i] = i;

  Observability result;
  while (!active.empty()) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(part(scaled, active));
    if (!(solver.eigenvalues()[0] < 1)) break;
    const Eigen::VectorXd direction = solver.eigenvectors().col(0);
    const double largest = direction.cwiseAbs().maxCoeff();
    constexpr double kTakesPart = 0.05;
    std::size_t held = active.size();
    for (std::size_t i = 0; i < active.size(); ++i) {
      if (std::abs(direction[static_cast<Eigen::Index>(i)]) < kTakesPart * largest) continue;
      if (held == active.size() ||
          reluctance(names[free[active[i]]]) < reluctance(names[free[active[held]]])) {
        held = i;
      }
    }
    const auto value = [&](std::size_t i) {
      return direction[static_cast<Eigen::Index>(i)] * prior[static_cast<Eigen::Index>(active[i])];
    };
    std::string combination;
    for (std::size_t i = 0; i < active.size(); ++i) {
      if (i == held || std::abs(direction[static_cast<Eigen::Index>(i)]) < kTakesPart * largest) continue;
      const double slope = -value(i) / value(held);
      combination +=
          fmt::format("{}{} {} {:.4g} * {}", combination.empty() ? "" : ", ", names[free[active[i]]],
                      slope < 0 ? "-" : "+", std::abs(slope), names[free[active[held]]]);
    }
    result.unobservable.push_back({.parameter = names[free[active[held]]],
                                   .reason = "these data do not determine it better than was known before",
                                   .combination = combination});
    active.erase(active.begin() + static_cast<std::ptrdiff_t>(held));
  }
  for (const auto i : active) result.known.push_back(free[i]);
  return result;
}

}  // namespace crisp
