// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/observability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp::estimate {
namespace {

/// Which kind of parameter is held at its prior first.
int reluctance(const std::string& name) {
  const std::vector<std::string> order = {".eta", ".alpha", ".lambda", ".tau"};
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (name.ends_with(order[i])) return static_cast<int>(i) + 1;
  }
  return 0;  // terms beyond equation (2) go before all of it
}

/// Parameters that take part in a direction, by their share of its largest component.
constexpr double kTakesPart = 0.05;

/// Which of the `active` parameters is held at its prior, so that this direction is no longer free.
std::size_t to_hold(const Eigen::VectorXd& direction, const std::vector<std::size_t>& active,
                    const std::vector<std::size_t>& free, const std::vector<std::string>& names) {
  const double largest = direction.cwiseAbs().maxCoeff();
  std::size_t held = active.size();
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (std::abs(direction[static_cast<Eigen::Index>(i)]) < kTakesPart * largest) continue;
    const auto rank = [&](std::size_t k) { return reluctance(names[free[active[k]]]); };
    if (held == active.size() || rank(i) < rank(held)) held = i;
  }
  return held;
}

}  // namespace

std::string known_with(std::size_t held, const std::vector<std::size_t>& known, const Eigen::MatrixXd& scaled,
                       const std::vector<std::string>& names, const Eigen::VectorXd& scale) {
  if (known.empty()) return {};
  const auto h = static_cast<Eigen::Index>(held);
  const Eigen::VectorXd made_up =
      statistics::solve_positive_definite(scaled(known, known), Eigen::VectorXd(scaled(known, held)));
  const double largest = made_up.cwiseAbs().maxCoeff();
  std::string text;
  if (largest < kTakesPart) return text;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const double share = made_up[static_cast<Eigen::Index>(i)];
    if (std::abs(share) < kTakesPart * largest) continue;
    const double slope = share * scale[static_cast<Eigen::Index>(known[i])] / scale[h];
    text += fmt::format("{}{} {} {:.4g} * {}", text.empty() ? "" : ", ", names[known[i]],
                        slope < 0 ? "-" : "+", std::abs(slope), names[held]);
  }
  return text;
}

Observability observability(const Eigen::MatrixXd& information, const std::vector<std::size_t>& free,
                            const std::vector<std::string>& names, const Eigen::VectorXd& prior) {
  const Eigen::MatrixXd scaled = prior.asDiagonal() * information * prior.asDiagonal();
  std::vector<std::size_t> active(free.size());
  std::iota(active.begin(), active.end(), std::size_t{0});
  std::vector<std::size_t> held;
  while (!active.empty()) {
    const statistics::SymmetricEigen eigen = statistics::eigendecomposition(scaled(active, active));
    if (!(eigen.values[0] < 1)) break;
    const auto next =
        active.begin() + static_cast<std::ptrdiff_t>(to_hold(eigen.vectors.col(0), active, free, names));
    held.push_back(*next);
    active.erase(next);
  }
  std::sort(held.begin(), held.end());

  std::vector<std::string> free_names;
  for (const std::size_t slot : free) free_names.push_back(names[slot]);
  Observability result;
  for (const std::size_t i : active) result.known.push_back(free[i]);
  for (const std::size_t i : held) {
    result.unobservable.push_back({.parameter = free_names[i],
                                   .reason = "these data do not determine it better than the prior",
                                   .combination = known_with(i, active, scaled, free_names, prior)});
  }
  return result;
}

}  // namespace crisp::estimate
