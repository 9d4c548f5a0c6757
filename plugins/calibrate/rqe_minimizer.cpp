// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rqe_minimizer.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/estimate/displacement.hpp"
#include "pipeline/statistics/dense_solvers.hpp"
#include "plugins/calibrate/cloud_objective.hpp"

namespace crisp::calibrate {
namespace {

/// Columns that each displace the points by `step`.
Eigen::MatrixXd whitening(const Eigen::MatrixXd& displacement, const Eigen::VectorXd& range, double step) {
  constexpr double kUnseen = 1e-7;  // of a parameter's own displacement: directions that move next to nothing
  const Eigen::VectorXd size =
      displacement.diagonal().cwiseMax(0).cwiseSqrt().cwiseMax(1e-3 * step * range.cwiseInverse());
  const Eigen::MatrixXd scaled =
      size.cwiseInverse().asDiagonal() * displacement * size.cwiseInverse().asDiagonal();
  const statistics::SymmetricEigen eigen = statistics::eigendecomposition(scaled);
  const Eigen::VectorXd length = eigen.values.cwiseMax(kUnseen).cwiseSqrt();
  return step * (size.cwiseInverse().asDiagonal() * eigen.vectors * length.cwiseInverse().asDiagonal());
}

/// From step to step η may move on by its range, but not to where the encoder readings no longer cover the
/// beams.
void keep_covered(Box& box, const SensorModel& model, const std::vector<std::size_t>& free,
                  const estimate::ParameterPrior& range) {
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (!model.names()[free[i]].ends_with(".eta")) continue;
    for (double* end : {&box.lower[static_cast<Eigen::Index>(i)], &box.upper[static_cast<Eigen::Index>(i)]}) {
      *end = std::clamp(*end, range.earliest_eta, range.latest_eta);
    }
  }
}

}  // namespace

Eigen::MatrixXd search_basis(const SensorModel& model, const estimate::Sample& sample,
                             const std::vector<std::size_t>& free, const estimate::ParameterPrior& range,
                             double scale) {
  return whitening(estimate::displacement(model, sample, free), estimate::ranges_of(range, model, free),
                   scale);
}

Minimum minimize_rqe(SensorModel& model, const estimate::Sample& sample, const std::vector<std::size_t>& free,
                     Measure& measure, double scale, const estimate::ParameterPrior& range,
                     const MinimizerSettings& settings) {
  const Eigen::VectorXd start = estimate::picked(model, free);
  const Eigen::VectorXd ranges = estimate::ranges_of(range, model, free);
  const Eigen::VectorXd centres = estimate::centres_of(range, model, free);
  Box box{.lower = centres - ranges,
          .upper = centres + ranges,
          .basis = search_basis(model, sample, free, range, scale)};
  keep_covered(box, model, free, range);
  const Objective objective = [&](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    const auto quality = model_quality(estimate::with(model, free, x), sample, free, measure, scale);
    if (gradient) *gradient = quality.gradient;
    return quality.value;
  };
  Minimum minimum = minimize(objective, start, box, settings);
  model = estimate::with(model, free, minimum.x);
  return minimum;
}

MinimizerSettings rough(MinimizerSettings settings) {
  constexpr double kTolerance = 1e-3;  // some hundredths of σ off the optimum, which itself is σ-dependent
  settings.tolerance = std::max(settings.tolerance, kTolerance);
  return settings;
}

std::vector<double> annealing(double from, double to) {
  constexpr double kFactor = 0.6;
  const auto steps = static_cast<int>(std::max(0.0, std::round(std::log(to / from) / std::log(kFactor))));
  std::vector<double> sigmas;
  for (int i = 0; i <= steps; ++i) {
    sigmas.push_back(steps == 0 ? to : from * std::pow(to / from, static_cast<double>(i) / steps));
  }
  return sigmas;
}

}  // namespace crisp::calibrate
