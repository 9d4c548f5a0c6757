// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/noise_plots.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::plot;

constexpr double kUsualSigma = 0.01;  // [m]
constexpr double kTailShare = 0.05;
constexpr double kTailScale = 4;

/// 20 beams at 1 to 20 m with a heavy tail.
RangeErrors with_tails() {
  std::mt19937_64 random(1);
  std::normal_distribution<> normal(0, kUsualSigma);
  std::bernoulli_distribution is_large(kTailShare);
  RangeErrors errors;
  for (std::uint32_t i = 0; i < 40'000; ++i) {
    errors.value.push_back(static_cast<float>((is_large(random) ? kTailScale : 1) * normal(random)));
    errors.range.push_back(1.0F + static_cast<float>(i % 20));
    errors.beam.push_back(static_cast<std::uint16_t>(i % 20));
    errors.block.push_back(i / 100);
  }
  return errors;
}

NoiseDiagnosis known_tails() {
  NoiseDiagnosis noise;
  noise.plain.size[0] = kUsualSigma * std::sqrt(1 + kTailShare * (kTailScale * kTailScale - 1));
  noise.model.size[0] = kUsualSigma;
  noise.model.has_tail = true;
  noise.model.tail_share = kTailShare;
  noise.model.tail_scale = kTailScale;
  return noise;
}

/// Mean squared difference of a curve from the measured one, in standard errors.
double misfit(const Plot& plot, std::size_t curve) {
  const PlotSeries& measured = plot.series.at(0);
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < measured.x.size(); ++i) {
    const double off = measured.y[i] - plot.series.at(curve).y[i];
    if (!std::isfinite(off)) continue;
    sum += std::pow(2 * off / measured.error[i], 2);
    count += 1;
  }
  return sum / count;
}

TEST(NoisePlots, ShowTheMeasuredDistributionNearTheNoiseModel) {
  const auto plots = noise_plots("laser1", with_tails(), known_tails());
  ASSERT_EQ(plots.size(), 2U);
  for (const Plot& plot : plots) {
    ASSERT_EQ(plot.series.size(), 3U);
    EXPECT_LT(misfit(plot, 2), 2) << plot.title;  // χ² of 80 bins, and of 12
  }
  EXPECT_GT(misfit(plots[0], 1), 20) << "normal noise";
}

TEST(NoisePlots, HaveNormalizedDensities) {
  const Plot plot = noise_plots("laser1", with_tails(), known_tails()).at(0);
  EXPECT_EQ(plot.y_scale, PlotScale::logarithmic);
  for (const PlotSeries& series : plot.series) {
    double sum = 0;
    for (const double density : series.y) sum += std::isfinite(density) ? density : 0;
    EXPECT_NEAR(sum * (series.x[1] - series.x[0]), 1, 0.01) << series.name;
  }
}

TEST(NoisePlots, ShowTheNormalModelOnceWithoutComponents) {
  NoiseDiagnosis normal;
  normal.plain.size[0] = normal.model.size[0] = kUsualSigma;
  for (const Plot& plot : noise_plots("laser1", with_tails(), normal)) EXPECT_EQ(plot.series.size(), 2U);
}

TEST(NoisePlots, CoverIncidenceAndRemissionIfTheyVary) {
  std::mt19937_64 random(1);
  std::normal_distribution<> normal;
  NoiseDiagnosis noise;
  noise.model.parts = {true, false, true, true};
  noise.model.size = {0.006, 0, 0.006, 0.05};
  noise.plain.size[0] = 0.011;
  RangeErrors errors;
  for (std::uint32_t i = 0; i < 40'000; ++i) {
    errors.range.push_back(3);
    errors.cosine.push_back(0.5F + 0.5F * static_cast<float>(i % 89) / 88);
    errors.remission.push_back(10.0F + static_cast<float>(i % 97));
    errors.beam.push_back(0);
    errors.block.push_back(i / 100);
    errors.value.push_back(static_cast<float>(noise.model.deviation(errors.echo(i), 0) * normal(random)));
  }
  const auto plots = noise_plots("laser1", errors, noise);
  ASSERT_EQ(plots.size(), 4U);
  EXPECT_THAT(plots[2].title, testing::HasSubstr("incidence"));
  EXPECT_EQ(plots[2].x_label, "incidence [deg]");
  EXPECT_NEAR(plots[2].series[0].x.front(), 8, 4) << "[deg] mean of the smallest twelfth up to 60 deg";
  EXPECT_NEAR(plots[2].series[0].x.back(), 58, 2);
  EXPECT_THAT(plots[3].title, testing::HasSubstr("remission"));
  for (const std::size_t k : {2U, 3U}) {
    EXPECT_LT(misfit(plots[k], 2), 2.5) << plots[k].title;  // χ² of 12 bins
    EXPECT_GT(misfit(plots[k], 1), 20) << "normal noise";
  }
  errors.remission.assign(errors.size(), 0);
  EXPECT_EQ(noise_plots("laser1", errors, noise).size(), 3U) << "without remission";
}

TEST(NoisePlots, AreEmptyWithoutRanges) { EXPECT_TRUE(noise_plots("laser1", {}, known_tails()).empty()); }

TEST(QuantizationPlot, HasItsPeakAtWholeSteps) {
  std::vector<float> ranges;
  for (int i = 100; i < 1100; ++i) ranges.push_back(0.01F * static_cast<float>(i));
  const Plot plot = quantization_plot("laser1", ranges, 0.01);
  const auto& measured = plot.series.at(0);
  const auto highest = std::ranges::max_element(measured.y) - measured.y.begin();
  EXPECT_LT(std::abs(measured.x[static_cast<std::size_t>(highest)]), 0.25) << "[mm]";
  EXPECT_GT(*std::ranges::max_element(measured.y), 40) << "[%]";
}

TEST(EdgePlot, CountsMixedPixelsByPosition) {
  const Plot plot = edge_plot("laser1", {.mixed = {true, false, true, false}, .places = {0.15, 0.85}});
  EXPECT_THAT(plot.title, testing::HasSubstr("50.0 % of 4 edges"));
  EXPECT_EQ(plot.series.at(0).y[1], 50);
  EXPECT_EQ(plot.series.at(0).y[8], 50);
  EXPECT_EQ(plot.series.at(0).y[5], 0);
}

TEST(MovingPlot, CountsOccludedDirectionsByTime) {
  const auto none = Visibility::kNone, surface = Visibility::kSurface, hidden = Visibility::kHidden;
  const ChangingDirections directions{.views = {{surface, hidden, none}, {surface, hidden, hidden}},
                                      .neighbours = {}};
  EXPECT_THAT(moving_plot(directions).series.at(0).y, testing::ElementsAre(0, 2, 1));
}

}  // namespace
}  // namespace crisp
