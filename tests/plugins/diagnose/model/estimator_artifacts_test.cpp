// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/estimator_artifacts.hpp"

#include <gmock/gmock.h>

#include "tests/plugins/diagnose/hidden.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;
using namespace crisp::simulate;

/// Recording with mirrors at exactly their nominal rate.
test::Recording at_constant_rate(double rate) {
  ScannerSettings scanner = test::scanner_of(1, 10);
  scanner.mirror.slowest = 0;
  scanner.mirror.wander = 0;
  scanner.motion = {.kind = MotionKind::constant, .max_rate = rate};
  return test::recorded(scanner, office());
}

TEST(EstimatorArtifacts, ACommensurateRateShowsFewDirections) {
  const auto found = aliasing(at_constant_rate(0.5).sample());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->name, "aliasing");
  EXPECT_EQ(found->parameters.at(0).value, 100) << "scans per turn";
  EXPECT_THAT(found->reason, testing::HasSubstr("3.60 deg apart"));
  EXPECT_EQ(aliasing(at_constant_rate(2).sample())->parameters.at(0).value, 25);
}

TEST(EstimatorArtifacts, OtherRatesAndChangingOnesShowManyDirections) {
  EXPECT_FALSE(aliasing(at_constant_rate(0.4873).sample()));
  EXPECT_FALSE(aliasing(test::hidden(2, 10, office(), {}).sample()));
  EXPECT_FALSE(aliasing(at_constant_rate(0.1).sample())) << "a single turn";
  EXPECT_FALSE(aliasing({}));
}

class DensityBias : public testing::Test {
 protected:
  DensityBias() : recording_(test::hidden(3, 4, office(), {})), came_(recording_.scanner.truth) {
    came_.lasers[1].tau.value += 0.002;
    came_.provenance["calibration"] = "calibrate.rqe";
    plain_ = refine_by_surfels(SensorModel(came_), recording_.sample(), {}).outcome;
  }
  test::Recording recording_;
  Calibration came_;
  Outcome plain_{.model = SensorModel(Calibration{}), .free = {}, .covariance = {}, .unobservable = {}};
};

TEST_F(DensityBias, IsTheDifferenceOfEntropyAndSurfaceEstimates) {
  const auto found = density_bias(came_, plain_);
  ASSERT_TRUE(found);
  const auto tau = std::ranges::find(found->parameters, "laser2.tau", &Parameter::name);
  ASSERT_NE(tau, found->parameters.end());
  EXPECT_NEAR(tau->value, 0.002, 4 * tau->std_error);
  EXPECT_EQ(tau->unit, "m");
}

TEST_F(DensityBias, IsTestedForEntropyCalibrationsOnly) {
  Calibration refined = came_;
  refined.provenance["refinement"] = "calibrate.refine";
  EXPECT_FALSE(density_bias(refined, plain_));
  Calibration other = came_;
  other.provenance.clear();
  EXPECT_FALSE(density_bias(other, plain_));
  EXPECT_FALSE(density_bias(calibration_of(plain_, default_rig()), plain_));
}

}  // namespace
}  // namespace crisp
