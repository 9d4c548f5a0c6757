// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/observability.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::estimate;

const std::vector<std::string> kNames = {"laser1.eta", "laser1.tau", "laser2.lambda", "laser2.eta"};
const std::vector<std::size_t> kFree = {1, 2, 3};
const Eigen::Vector3d kPrior(0.1, 0.25, 0.1);

TEST(Observability, OfWellDeterminedParametersIsComplete) {
  const auto result = observability(Eigen::Vector3d(1e6, 1e6, 1e6).asDiagonal(), kFree, kNames, kPrior);
  EXPECT_EQ(result.known, kFree);
  EXPECT_TRUE(result.unobservable.empty());
}

TEST(Observability, AtConstantSpeedNamesEtaAndTheCombinationThatIsKnown) {
  // Only λ + 6 rad/s · η is measured, to a milliradian.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information(0, 0) = 1e6;
  const Eigen::Vector2d row(1, 6);
  information.bottomRightCorner<2, 2>() = 1e6 * row * row.transpose();
  const auto result = observability(information, kFree, kNames, kPrior);
  ASSERT_EQ(result.unobservable.size(), 1U);
  EXPECT_EQ(result.unobservable[0].parameter, "laser2.eta");
  EXPECT_EQ(result.unobservable[0].combination, "laser2.lambda + 6 * laser2.eta");
  EXPECT_EQ(result.known, (std::vector<std::size_t>{1, 2}));
}

TEST(Observability, NamesAParameterThatNothingDependsOn) {
  const auto result = observability(Eigen::Vector3d(0, 1e6, 1e6).asDiagonal(), kFree, kNames, kPrior);
  ASSERT_EQ(result.unobservable.size(), 1U);
  EXPECT_EQ(result.unobservable[0].parameter, "laser1.tau");
  EXPECT_EQ(result.unobservable[0].combination, "");
}

}  // namespace
}  // namespace crisp
