// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/cloud_objective.hpp"

#include "pipeline/estimate/placed_beams.hpp"

namespace crisp::calibrate {
namespace {

Vectors as_arrays(const Placed& placed, const estimate::Sample& sample) {
  if (placed.index.size() != sample.beams.size()) throw estimate::UncoveredBeams();
  Vectors arrays;
  arrays.assign(placed.index.size(), 0);
  for (std::size_t i = 0; i < placed.index.size(); ++i) {
    const auto point = placed.points.col(static_cast<Eigen::Index>(i));
    arrays.x[i] = point.x();
    arrays.y[i] = point.y();
    arrays.z[i] = point.z();
  }
  return arrays;
}

}  // namespace

ModelQuality model_quality(const SensorModel& model, const estimate::Sample& sample,
                           const std::vector<std::size_t>& free, Measure& measure, double scale) {
  PointDerivatives derivatives;
  const Placed placed = model.place(sample.beams, *sample.plate, free, derivatives);
  const Quality cloud = measure.evaluate(as_arrays(placed, sample).view(), {}, scale, true);

  ModelQuality quality{.value = cloud.value,
                       .gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free.size()))};
  for (std::size_t i = 0; i < placed.index.size(); ++i) {
    const Eigen::Vector3d gradient(cloud.gradient.x[i], cloud.gradient.y[i], cloud.gradient.z[i]);
    const auto& columns = derivatives.columns[sample.beams.laser[i]];
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(i * derivatives.stride + k);
      quality.gradient[static_cast<Eigen::Index>(columns[k])] += gradient.dot(derivatives.values.col(column));
    }
  }
  return quality;
}

double model_quality(const SensorModel& model, const estimate::Sample& sample, Measure& measure,
                     double scale) {
  return measure.evaluate(estimate::place_all(model, sample.beams, *sample.plate).view(), {}, scale, false)
      .value;
}

}  // namespace crisp::calibrate
