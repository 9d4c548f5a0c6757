// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/cloud_objective.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using namespace crisp::estimate;
using namespace crisp::simulate;

std::unique_ptr<Measure> exact_entropy() {
  SearchRegistry searches;
  register_built_in(searches);
  MeasureRegistry measures;
  register_built_in(measures);
  return measures.make("rqe", {.search = "exact", .cutoff = 6}, searches);
}

TEST(ModelQuality, ItsGradientAgreesWithFiniteDifferencesForEveryParameter) {
  const auto recording = simulate_measurements(misplaced_scanner(2, 1.0), office());
  const SensorModel model(recording.truth);
  const Sample sample = thin_by_area(covered(sample_of(recording), -0.01, 0.01), model, 1500, 1);
  const auto measure = exact_entropy();
  constexpr double kSigma = 0.2;
  const auto quality = model_quality(model, sample, all_free(), *measure, kSigma);
  for (std::size_t f = 0; f < all_free().size(); ++f) {
    constexpr double kStep = 1e-5;
    const auto moved = [&](double step) {
      SensorModel other = model;
      Eigen::VectorXd values = model.values();
      values[static_cast<Eigen::Index>(all_free()[f])] += step;
      other.set_values(values);
      return model_quality(other, sample, *measure, kSigma);
    };
    const double difference = (moved(kStep) - moved(-kStep)) / (2 * kStep);
    const double gradient = quality.gradient[static_cast<Eigen::Index>(f)];
    EXPECT_NEAR(gradient, difference, 1e-4 * (1 + std::abs(gradient))) << model.names()[all_free()[f]];
  }
}

}  // namespace
}  // namespace crisp
