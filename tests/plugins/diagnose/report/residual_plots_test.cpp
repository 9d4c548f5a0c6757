// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report/residual_plots.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::plot;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::string> kLasers = {"laser1", "laser2", "laser3"};

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

ProfileComparison some_profiles(double hypothesis) {
  return {
      .profiles = {
          {.covariate = "mirror angle",
           .unit = "rad",
           .laser = 1,
           .bins = {{.at = -std::numbers::pi / 2, .measured = hypothesis, .simulated = 1e-4, .error = 2e-4},
                    {.at = 0, .measured = -hypothesis, .simulated = -2e-4, .error = 3e-4}},
           .rms = hypothesis,
           .p_value = 0.005},
          {.covariate = "remission", .unit = "", .laser = 0, .bins = {{.at = 3}}}}};
}

TEST(ResidualPlots, ShowMeasuredAndSimulatedBeforeAndAfter) {
  const auto plots = residual_plots(1, kLasers, some_profiles(4e-3), some_profiles(3e-4));
  ASSERT_EQ(plots.size(), 1U) << "the other profile is of another laser";
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

TEST(ResidualPlots, ShowOneModelWithoutFindings) {
  const auto plots = residual_plots(1, kLasers, some_profiles(4e-3), some_profiles(4e-3));
  ASSERT_EQ(plots.size(), 1U);
  EXPECT_EQ(plots[0].series.size(), 2U);
  EXPECT_EQ(residual_plots(0, kLasers, some_profiles(0), some_profiles(0))[0].x_label, "remission");
  EXPECT_TRUE(residual_plots(2, kLasers, some_profiles(0), some_profiles(0)).empty());
}

TEST(ResidualPlots, LabelSidesAndLasers) {
  const ProfileComparison both{
      .profiles = {{.covariate = "front/back", .laser = 0, .bins = {{.at = 0}, {.at = 1}}},
                   {.covariate = "laser", .laser = kAllLasers, .bins = {{.at = 1}, {.at = 3}}}}};
  const Plot sides = residual_plots(0, kLasers, both, both).at(0);
  EXPECT_THAT(names_of(sides.kinds), ElementsAre("front", "back"));
  EXPECT_THAT(sides.title, HasSubstr("laser1"));
  const Plot lasers = residual_plots(kAllLasers, kLasers, both, both).at(0);
  EXPECT_THAT(lasers.title, HasSubstr("scanner"));
  EXPECT_THAT(names_of(lasers.kinds), ElementsAre("laser1", "laser3")) << "the second has no residuals";
  EXPECT_EQ(lasers.kinds.at(1).at, 2) << "adjacent, whatever their numbers";
  EXPECT_THAT(lasers.series.at(0).x, ElementsAre(1, 2));
}

TEST(ResidualPlots, BreakTheLineBetweenRecordings) {
  const ProfileComparison two{
      .profiles = {{.covariate = "time",
                    .unit = "s",
                    .laser = 0,
                    .bins = {{.at = 1}, {.at = 2}, {.at = 62, .recording = 1}, {.at = 63, .recording = 1}}}}};
  const Plot plot = residual_plots(0, kLasers, two, two).at(0);
  EXPECT_THAT(plot.series.at(0).x, ElementsAre(1, 2, testing::IsNan(), 62, 63));
  EXPECT_EQ(plot.series[0].y.size(), 5U);
  EXPECT_EQ(plot.series[0].error.size(), 5U);
}

TEST(ResidualPlots, BeginWithTheDistributionOnALogarithmicAxis) {
  ProfileComparison before = some_profiles(4e-3);
  before.distributions = {{.laser = 1,
                           .bins = {{.at = -0.125, .measured = 0.3, .simulated = 0.4, .error = 0.01},
                                    {.at = 0.125, .measured = 0, .simulated = 0.4},
                                    {.at = 0.375, .measured = 0, .simulated = 0.001}},
                           .single = 0.02,
                           .measured_rms = 1.2,
                           .simulated_rms = 0.99}};
  ProfileComparison after = before;
  const Plot once = residual_plots(1, kLasers, before, after).at(0);
  EXPECT_THAT(names_of(once.series), ElementsAre("measured", "simulated"));
  after.distributions[0].bins[0].measured = 0.39;
  after.distributions[0].measured_rms = 1;
  const auto plots = residual_plots(1, kLasers, before, after);
  ASSERT_EQ(plots.size(), 2U);
  const Plot& plot = plots[0];
  EXPECT_EQ(plot.y_scale, PlotScale::logarithmic);
  EXPECT_THAT(plot.title, HasSubstr("laser2: standardized residuals, RMS 1.20 (simulated 0.99), then 1.00"));
  EXPECT_THAT(names_of(plot.series), ElementsAre("measured before", "simulated", "measured after"));
  EXPECT_THAT(plot.series[0].y, ElementsAre(0.3, 0, 0));
  EXPECT_THAT(plot.series[0].error, ElementsAre(0.02, 0, 0));
  EXPECT_THAT(plot.series[1].y, ElementsAre(0.4, 0.4)) << "bins below a tenth of a residual are left out";
  EXPECT_THAT(plot.series[2].y, ElementsAre(0.39, 0, 0));
  EXPECT_EQ(residual_plots(0, kLasers, before, after).size(), 1U) << "laser 1 has no residuals";
}

}  // namespace
}  // namespace crisp
