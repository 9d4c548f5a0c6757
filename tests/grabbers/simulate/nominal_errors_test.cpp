// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/nominal_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <crisp/error.hpp>
#include <crisp/rig.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::simulate;

TEST(DrawTruth, StaysWithinTheDeparturesAndKeepsTheGauge) {
  const Calibration nominal = nominal_calibration(default_rig());
  const NominalErrors nominal_errors{.tau = 0.02, .alpha = 3 * kDegree, .lambda = 5 * kDegree, .eta = 0.04};
  double widest = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Calibration truth = draw_truth(nominal, nominal_errors, seed);
    EXPECT_EQ(truth.lasers[0].lambda.value, 0);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(std::abs(truth.lasers[i].tau.value - 0.20), 0.02);
      EXPECT_LE(std::abs(truth.lasers[i].alpha.value), 3 * kDegree);
      EXPECT_LE(std::abs(truth.lasers[i].eta.value), 0.04);
      EXPECT_LE(std::abs(truth.lasers[i].lambda.value - static_cast<double>(i) * 120 * kDegree), 5 * kDegree);
      widest = std::max(widest, std::abs(truth.lasers[i].eta.value));
    }
  }
  EXPECT_GT(widest, 0.039);
  EXPECT_THROW(draw_truth(nominal, {.tau = -1}, 1), Error);
}

}  // namespace
}  // namespace crisp
