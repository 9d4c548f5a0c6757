// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/sandwich_covariance.hpp"

#include <algorithm>
#include <random>

#include "pipeline/statistics/dense_solvers.hpp"
#include "plugins/calibrate/cloud_objective.hpp"

namespace crisp::calibrate {
namespace {

using estimate::Sample;

/// The measure's gradient in the coordinates of a basis.
class Gradient {
 public:
  Gradient(const SensorModel& model, const std::vector<std::size_t>& free, Measure& measure, double scale,
           const Eigen::MatrixXd& basis)
      : model_(model), free_(free), measure_(measure), scale_(scale), basis_(basis) {}

  SensorModel moved(const Eigen::VectorXd& step) const {
    return estimate::with(model_, free_, estimate::picked(model_, free_) + basis_ * step);
  }

  Eigen::VectorXd at(const Eigen::VectorXd& step, const Sample& sample) {
    return basis_.transpose() * model_quality(moved(step), sample, free_, measure_, scale_).gradient;
  }

 private:
  const SensorModel& model_;
  const std::vector<std::size_t>& free_;
  Measure& measure_;
  double scale_;
  const Eigen::MatrixXd& basis_;
};

constexpr double kStep = 0.1;  // of the scale, in the points' motion

/// The beams that encoder readings cover after each step, also where an η is near the end of its range.
Sample placeable_after_steps(const Gradient& gradient, Eigen::Index m, const Sample& sample) {
  Sample placed = sample;
  for (Eigen::Index k = 0; k < m; ++k) {
    for (const double step : {kStep, -kStep})
      placed = estimate::placeable(gradient.moved(step * Eigen::VectorXd::Unit(m, k)), placed);
  }
  return placed;
}

Eigen::MatrixXd hessian(Gradient& gradient, Eigen::Index m, const Sample& sample) {
  Eigen::MatrixXd result(m, m);
  for (Eigen::Index k = 0; k < m; ++k) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(m, k);
    result.col(k) = (gradient.at(step, sample) - gradient.at(-step, sample)) / (2 * kStep);
  }
  return (result + result.transpose()) / 2;
}

/// B = noise² Σᵢ (∂g/∂rᵢ)(∂g/∂rᵢ)ᵀ, as the mean over random signs of all ranges' changes.
Eigen::MatrixXd gradient_covariance(Gradient& gradient, Eigen::Index m, const Sample& sample,
                                    const SandwichSettings& settings) {
  constexpr float kChange = 0.002F;  // [m] small against the scale, large against rounding
  std::mt19937_64 bits(settings.seed);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(m, m);
  const Eigen::VectorXd here = Eigen::VectorXd::Zero(m);
  const std::size_t probes = std::max(settings.probes, static_cast<std::size_t>(2 * m));  // B must be regular
  for (std::size_t probe = 0; probe < probes; ++probe) {
    Sample longer = sample;
    Sample shorter = sample;
    for (std::size_t i = 0; i < sample.beams.size(); ++i) {
      const float change = (bits() >> 63U) != 0 ? kChange : -kChange;
      longer.beams.range[i] += change;
      shorter.beams.range[i] -= change;
    }
    const Eigen::VectorXd slope = (gradient.at(here, longer) - gradient.at(here, shorter)) / (2 * kChange);
    sum.selfadjointView<Eigen::Upper>().rankUpdate(slope);
  }
  sum = sum.selfadjointView<Eigen::Upper>();
  return sum * (settings.noise * settings.noise / static_cast<double>(probes));
}

}  // namespace

Eigen::MatrixXd sandwich(const Eigen::MatrixXd& hessian, const Eigen::MatrixXd& spread,
                         const Eigen::MatrixXd& basis, const Eigen::VectorXd& ranges) {
  constexpr double kBeyond = 10;  // times the range: clearly not determined
  const statistics::SymmetricEigen curvature = statistics::eigendecomposition(hessian);
  const double flat = 1e-9 * std::max(1e-300, curvature.values.cwiseAbs().maxCoeff());
  const auto has_minimum = (curvature.values.array() > flat).eval();
  const Eigen::VectorXd inverse = has_minimum.select(curvature.values.cwiseInverse(), 0);
  const Eigen::MatrixXd influence = curvature.vectors * inverse.asDiagonal() * curvature.vectors.transpose();
  Eigen::MatrixXd scatter = basis * influence * spread * influence * basis.transpose();
  for (Eigen::Index k = 0; k < hessian.rows(); ++k) {
    if (has_minimum[k]) continue;
    const Eigen::VectorXd direction = basis * curvature.vectors.col(k);
    const double reach = kBeyond / direction.cwiseQuotient(ranges).norm();
    scatter += reach * reach * direction * direction.transpose();
  }
  return (scatter + scatter.transpose()) / 2;
}

Eigen::MatrixXd sandwich_covariance(const SensorModel& model, const Sample& sample,
                                    const std::vector<std::size_t>& free, Measure& measure,
                                    const SandwichSettings& settings) {
  const auto m = static_cast<Eigen::Index>(free.size());
  const Eigen::MatrixXd basis = search_basis(model, sample, free, settings.range, settings.scale);
  const Eigen::VectorXd ranges = estimate::ranges_of(settings.range, model, free);
  Gradient gradient(model, free, measure, settings.scale, basis);
  const Sample placed = placeable_after_steps(gradient, m, sample);
  const Eigen::MatrixXd scatter = sandwich(hessian(gradient, m, placed),
                                           gradient_covariance(gradient, m, placed, settings), basis, ranges);
  const Eigen::VectorXd least = 1e-12 * ranges.cwiseAbs2();
  return scatter + Eigen::MatrixXd(least.asDiagonal());
}

}  // namespace crisp::calibrate
