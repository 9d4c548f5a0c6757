// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/clock_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pipeline/clocks/series.hpp"
#include "pipeline/statistics/dense_solvers.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/noise/permutation_test.hpp"

namespace crisp::diagnose {
namespace {

constexpr Eigen::Index kHighest = 12;  // order: four periods of a wave

/// Legendre polynomials of orders 2 … kHighest over the recording: a column each.
Eigen::MatrixXd bends(const Eigen::VectorXd& time) {
  const double middle = (time.maxCoeff() + time.minCoeff()) / 2;
  const double half = std::max((time.maxCoeff() - time.minCoeff()) / 2, std::numeric_limits<double>::min());
  Eigen::MatrixXd columns(time.size(), kHighest - 1);
  for (Eigen::Index k = 0; k < time.size(); ++k) {
    for (Eigen::Index order = 2; order <= kHighest; ++order) {
      const double x = std::clamp((time[k] - middle) / half, -1.0, 1.0);
      columns(k, order - 2) = std::legendre(static_cast<unsigned>(order), x);
    }
  }
  return columns;
}

/// [s] Standard deviation of a minimum delay, by its difference to the next.
double scatter_of(const Eigen::VectorXd& lead) {
  std::vector<double> steps;
  for (Eigen::Index k = 1; k < lead.size(); ++k) steps.push_back(std::abs(lead[k] - lead[k - 1]));
  return statistics::kMadToSigma * statistics::median_in_place(steps) / std::sqrt(2);
}

}  // namespace

std::optional<ClockCurve> smooth_curve(const clocks::Envelope& envelope, std::uint64_t seed) {
  constexpr double kSmooth = 1.5;  // times the scatter
  const Eigen::Index n = envelope.lead.size();
  const Eigen::MatrixXd base = envelope.straight();
  const Eigen::MatrixXd columns = clocks::off_base(base, bends(envelope.time));
  const Eigen::VectorXd left = clocks::off_base(base, envelope.lead);
  ClockCurve best;
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index bent = 1; bent <= columns.cols() && bent + base.cols() < n; ++bent) {
    const Eigen::MatrixXd some = columns.leftCols(bent);
    const Eigen::VectorXd delay = some * statistics::least_squares(some, left);
    const double squares = (left - delay).squaredNorm();
    const double bic = bic_of_series(squares, n, static_cast<double>(base.cols() + bent));
    if (!(bic < least)) continue;
    least = bic;
    best = {.delay = delay, .squares = squares, .parameters = bent, .gain = {}};
  }
  if (best.parameters == 0) return std::nullopt;
  const auto values = static_cast<double>(n);
  const double rms = std::sqrt(best.squares / values);
  if (rms > kSmooth * scatter_of(envelope.lead)) return std::nullopt;
  best.size = std::sqrt(best.delay.squaredNorm() / values);
  best.std_error = rms / std::sqrt(values);
  best.gain = gain_in_series(base, columns.leftCols(best.parameters), envelope.lead, seed);
  return best;
}

}  // namespace crisp::diagnose
