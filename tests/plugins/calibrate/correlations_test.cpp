// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/correlations.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::calibrate;

TEST(Correlations, AreTheStrongestFirstWhateverTheirSign) {
  Calibration calibration;
  calibration.covariance_order = {"laser1.tau", "laser1.eta", "laser2.lambda"};
  calibration.covariance = {4,    0.2, -1.9,  //
                            0.2,  1,   0.9,   //
                            -1.9, 0.9, 1};
  const auto found = strongest_correlations(calibration, 2, 0.5);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].one + " " + found[0].other, "laser1.tau laser2.lambda");
  EXPECT_NEAR(found[0].value, -0.95, 1e-12);
  EXPECT_NEAR(found[1].value, 0.9, 1e-12);
  EXPECT_TRUE(strongest_correlations({}, 2, 0.5).empty());
}

}  // namespace
}  // namespace crisp
