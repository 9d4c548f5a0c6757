// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rqe_minimizer.hpp"

#include <gtest/gtest.h>

#include "plugins/calibrate/cloud_objective.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using namespace crisp::estimate;
using namespace crisp::simulate;

TEST(Annealing, GoesFromWideToNarrowByOneFactor) {
  const auto sigmas = annealing(0.5, 0.1);
  EXPECT_DOUBLE_EQ(sigmas.front(), 0.5);
  EXPECT_DOUBLE_EQ(sigmas.back(), 0.1);
  for (std::size_t i = 2; i < sigmas.size(); ++i) {
    EXPECT_NEAR(sigmas[i] / sigmas[i - 1], sigmas[1] / sigmas[0], 1e-12);
  }
  EXPECT_EQ(annealing(0.1, 0.1), std::vector<double>{0.1});
}

TEST(RqeMinimizer, ReachesALowerEntropyThanTheTruthAndEndsNearIt) {
  const auto recording = simulate_measurements(misplaced_scanner(3, 4.0), office());
  SensorModel model(recording.truth);
  const Eigen::VectorXd truth = model.values();
  Eigen::VectorXd off = truth;
  for (const auto tau : {1, 5, 9}) off[tau] += 0.01;
  for (const auto eta : {3, 7, 11}) off[eta] -= 0.003;
  model.set_values(off);
  const Sample sample = thin_by_area(covered(sample_of(recording), -0.11, 0.11), model, 20000, 1);
  const auto measure = rqe_measure();
  const auto minimum = minimize_rqe(model, sample, all_free(), *measure, 0.1, {}, {.tolerance = 1e-7});
  EXPECT_TRUE(minimum.converged) << minimum.status;
  // The minimum of a function is at most its value anywhere, at the truth too.
  EXPECT_LE(minimum.value, model_quality(SensorModel(recording.truth), sample, *measure, 0.1));
  // At σ = 0.1 m RQE's own bias is below a centimetre in the office.
  for (const auto tau : {1, 5, 9}) EXPECT_NEAR(model.values()[tau], truth[tau], 0.012);
  for (const auto eta : {3, 7, 11}) EXPECT_NEAR(model.values()[eta], truth[eta], 0.001);
}

}  // namespace
}  // namespace crisp
