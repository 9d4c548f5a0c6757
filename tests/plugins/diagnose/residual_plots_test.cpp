// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/residual_plots.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace crisp {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

SideBySide some_profiles(double departure) {
  return {
      .profiles = {
          {.covariate = "mirror angle",
           .unit = "rad",
           .laser = 1,
           .bins = {{.at = -std::numbers::pi / 2, .measured = departure, .simulated = 1e-4, .error = 2e-4},
                    {.at = 0, .measured = -departure, .simulated = -2e-4, .error = 3e-4}},
           .rms = departure,
           .p_value = 0.005},
          {.covariate = "remission", .unit = "", .laser = 0, .bins = {{.at = 3}}}}};
}

TEST(ResidualPlots, ShowMeasuredBesideSimulatedBeforeAndAfter) {
  const auto plots = residual_plots(1, "laser2", some_profiles(4e-3), some_profiles(3e-4));
  ASSERT_EQ(plots.size(), 1U) << "the other is of another laser";
  const Plot& plot = plots[0];
  EXPECT_THAT(plot.title, HasSubstr("laser2 against mirror angle: 4.00 mm (p = 0.005), then 0.30 mm"));
  EXPECT_EQ(plot.x_label, "mirror angle [deg]");
  ASSERT_EQ(plot.series.size(), 4U);
  EXPECT_THAT(plot.series[0].x, ElementsAre(DoubleNear(-90, 1e-9), DoubleNear(0, 1e-9)));
  EXPECT_THAT(plot.series[0].y, ElementsAre(DoubleNear(4, 1e-9), DoubleNear(-4, 1e-9)));
  EXPECT_THAT(plot.series[0].error, ElementsAre(DoubleNear(0.4, 1e-9), DoubleNear(0.6, 1e-9)));
  EXPECT_THAT(plot.series[1].y, ElementsAre(DoubleNear(0.1, 1e-9), DoubleNear(-0.2, 1e-9)));
  EXPECT_FALSE(plot.series[1].joined);
  EXPECT_THAT(plot.series[2].y, ElementsAre(DoubleNear(0.3, 1e-9), DoubleNear(-0.3, 1e-9)));
  EXPECT_THAT(plot.series[3].name, HasSubstr("simulated after"));
}

TEST(ResidualPlots, ShowOneModelWhereNothingWasFound) {
  const auto plots = residual_plots(1, "laser2", some_profiles(4e-3), some_profiles(4e-3));
  ASSERT_EQ(plots.size(), 1U);
  EXPECT_EQ(plots[0].series.size(), 2U);
  EXPECT_EQ(residual_plots(0, "laser1", some_profiles(0), some_profiles(0))[0].x_label, "remission");
  EXPECT_TRUE(residual_plots(2, "laser3", some_profiles(0), some_profiles(0)).empty());
}

}  // namespace
}  // namespace crisp
