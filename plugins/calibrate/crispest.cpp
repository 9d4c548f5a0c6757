// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/crispest.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "plugins/calibrate/cloud_objective.hpp"
#include "plugins/calibrate/wanted_terms.hpp"

namespace crisp {
namespace {

constexpr double kOfBounds = 0.05;  // share of a term's bounds that its parameters are looked for within

/// A shift and a small turn of everything move a point x by MΘ, M = [I, −[x]×]: the sum of all MᵀM.
class RigidMotions {
 public:
  void add(const Eigen::Vector3d& x) {
    ++points_;
    sum_ += x;
    squares_ += x * x.transpose();
  }
  Eigen::Matrix<double, 6, 6> gram() const {
    Eigen::Matrix3d turn;
    turn << 0, sum_.z(), -sum_.y(), -sum_.z(), 0, sum_.x(), sum_.y(), -sum_.x(), 0;
    Eigen::Matrix<double, 6, 6> all;
    all << Eigen::Matrix3d::Identity() * points_, turn, turn.transpose(),
        Eigen::Matrix3d::Identity() * squares_.trace() - squares_;
    return all;
  }

 private:
  double points_ = 0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
};

/// Columns that each displace the points by `step`.
Eigen::MatrixXd whitening(const Eigen::MatrixXd& displacement, const Eigen::VectorXd& range, double step) {
  constexpr double kUnseen = 1e-7;  // of a parameter's own displacement: directions that move next to nothing
  const Eigen::VectorXd size =
      displacement.diagonal().cwiseMax(0).cwiseSqrt().cwiseMax(1e-3 * step * range.cwiseInverse());
  const Eigen::MatrixXd scaled =
      size.cwiseInverse().asDiagonal() * displacement * size.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  const Eigen::VectorXd length = solver.eigenvalues().cwiseMax(kUnseen).cwiseSqrt();
  return step *
         (size.cwiseInverse().asDiagonal() * solver.eigenvectors() * length.cwiseInverse().asDiagonal());
}

}  // namespace

double range_of(const SearchRange& range, const std::string& name) {
  if (name.ends_with(".lambda")) return range.lambda;
  if (name.ends_with(".tau")) return range.tau;
  if (name.ends_with(".alpha")) return range.alpha;
  if (name.ends_with(".eta")) return range.eta;
  return range.other;
}

Eigen::VectorXd picked(const SensorModel& model, const std::vector<std::size_t>& free) {
  return model.values()(free);
}

Eigen::VectorXd ranges_of(const SearchRange& range, const SensorModel& model,
                          const std::vector<std::size_t>& free) {
  Eigen::VectorXd ranges(static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i) {
    const EffectParameter* term = declared(model, free[i]);
    const double width = term ? term->upper - term->lower : 0;
    ranges[static_cast<Eigen::Index>(i)] =
        width > 0 ? kOfBounds * width : range_of(range, model.names()[free[i]]);
  }
  return ranges;
}

SensorModel with(const SensorModel& model, const std::vector<std::size_t>& free, const Eigen::VectorXd& x) {
  Eigen::VectorXd values = model.values();
  values(free) = x;
  SensorModel moved = model;
  moved.set_values(values);
  return moved;
}

Eigen::MatrixXd displacement(const SensorModel& model, const Sample& sample,
                             const std::vector<std::size_t>& free) {
  PointDerivatives derivatives;
  const Placed placed = model.place(sample.beams, *sample.plate, free, derivatives);
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(6, n);
  RigidMotions motions;
  for (std::size_t i = 0; i < placed.index.size(); ++i) {
    const Eigen::Vector3d point = placed.points.col(static_cast<Eigen::Index>(i));
    const auto& columns = derivatives.columns[sample.beams.laser[placed.index[i]]];
    const auto first = static_cast<Eigen::Index>(i * derivatives.stride);
    motions.add(point);
    for (std::size_t a = 0; a < columns.size(); ++a) {
      const auto column = static_cast<Eigen::Index>(columns[a]);
      const Eigen::Vector3d step = derivatives.values.col(first + static_cast<Eigen::Index>(a));
      mixed.col(column).head<3>() += step;
      mixed.col(column).tail<3>() += point.cross(step);
      for (std::size_t b = 0; b < columns.size(); ++b) {
        own(column, static_cast<Eigen::Index>(columns[b])) +=
            step.dot(derivatives.values.col(first + static_cast<Eigen::Index>(b)));
      }
    }
  }
  const Eigen::Matrix<double, 6, 6> rigid =
      motions.gram() + Eigen::Matrix<double, 6, 6>::Identity() * 1e-9;  // points may all coincide
  own -= mixed.transpose() * rigid.ldlt().solve(mixed);
  return own / static_cast<double>(std::max<std::size_t>(1, placed.index.size()));
}

Eigen::MatrixXd search_basis(const SensorModel& model, const Sample& sample,
                             const std::vector<std::size_t>& free, const SearchRange& range, double scale) {
  return whitening(displacement(model, sample, free), ranges_of(range, model, free), scale);
}

Minimum crispest(SensorModel& model, const Sample& sample, const std::vector<std::size_t>& free,
                 Measure& measure, double scale, const SearchRange& range,
                 const MinimiserSettings& settings) {
  const Eigen::VectorXd start = picked(model, free);
  const Eigen::VectorXd ranges = ranges_of(range, model, free);
  const Box box{.lower = start - ranges,
                .upper = start + ranges,
                .basis = search_basis(model, sample, free, range, scale)};
  const Objective objective = [&](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    const auto quality = model_quality(with(model, free, x), sample, free, measure, scale);
    if (gradient) *gradient = quality.gradient;
    return quality.value;
  };
  Minimum minimum = minimise(objective, start, box, settings);
  model = with(model, free, minimum.x);
  return minimum;
}

MinimiserSettings rough(MinimiserSettings settings) {
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

}  // namespace crisp
