// SPDX-License-Identifier: BSD-3-Clause
// Goodness of fit has uniform p-values under the model, and rejects deviations from it.
#include "plugins/diagnose/noise/goodness_of_fit.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "plugins/diagnose/noise/noise_diagnosis.hpp"
#include "plugins/diagnose/report/findings_report.hpp"
#include "tests/support/kolmogorov.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;

using Random = std::mt19937_64;
using RangeErrorDraw = std::function<double(Random&, int beam, int scan)>;

constexpr int kBeams = 60;
constexpr int kScans = 50;

double standard(Random& random) { return std::normal_distribution<>()(random); }
double even(Random& random) { return std::uniform_real_distribution<>(0, 1)(random); }

/// Quantized ranges of stationary beams, less the mean of their beam.
RangeErrors shots(std::uint64_t seed, const RangeErrorDraw& error, double step = 1e-3, int scans = kScans) {
  Random random(seed);
  RangeErrors all;
  for (int beam = 0; beam < kBeams; ++beam) {
    const double range = 1 + 10 * even(random);
    double mean = 0;
    std::vector<double> values;
    for (int scan = 0; scan < scans; ++scan) {
      values.push_back(step * std::round((range + error(random, beam, scan)) / step));
      mean += values.back() / scans;
    }
    for (int scan = 0; scan < scans; ++scan) {
      all.value.push_back(static_cast<float>(values[static_cast<std::size_t>(scan)] - mean));
      all.range.push_back(static_cast<float>(mean));
      all.beam.push_back(static_cast<std::uint16_t>(beam));
      all.block.push_back(static_cast<std::uint32_t>(scan));
    }
  }
  return all;
}

double plain_error(Random& random, int, int) { return 4e-3 * standard(random); }

/// Two peaks as of an LMS111, with a weight per beam.
double about_two_values(Random& random, int beam, int) {
  const double weight = 0.2 + 0.7 * beam / kBeams;
  return 5e-3 * standard(random) + (even(random) < weight ? 15e-3 : 0);
}

NoiseModel with_two_peaks() {
  NoiseModel model{.size = {6e-3, 0, 0, 0}};
  model.weight.assign(kBeams, 0.5);
  model.separation = 14e-3;
  return model;
}

/// Expects uniform p-values for ranges of the model.
void expect_even(const NoiseModel& like, const RangeErrorDraw& error) {
  constexpr int kSeeds = 64;
  std::vector<double> chances;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    chances.push_back(
        goodness_of_noise_model(shots(seed, error), like, {}, BeamsOf::kLaserAtRest, seed).p_value);
  }
  EXPECT_LT(test::unevenness(chances), test::kUnevenOnceInAThousand) << ::testing::PrintToString(chances);
}

TEST(GoodnessOfFit, HasUniformPValuesForPlainNoise) { expect_even({}, plain_error); }

TEST(GoodnessOfFit, HasUniformPValuesForTwoPeaks) { expect_even(with_two_peaks(), about_two_values); }

TEST(GoodnessOfFit, AcceptsTwoPeaksWithTheirModel) {
  const RangeErrors measured = shots(3, about_two_values, 1e-3, 200);
  const NoiseModel found = diagnose_noise("laser1", measured, 1).model;
  ASSERT_TRUE(found.has_peaks());
  const GoodnessOfFit reported = goodness_of_fit("laser1", measured, found, {}, BeamsOf::kLaserAtRest, 1);
  EXPECT_LT(reported.before.p_value, 1e-12);
  EXPECT_GT(reported.after.p_value, 0.05);
}

TEST(GoodnessOfFit, RejectsNoiseThatDiffersBetweenBeams) {
  const RangeErrors measured = shots(
      4, [](Random& random, int beam, int) { return (beam % 2 == 0 ? 4e-3 : 8e-3) * standard(random); });
  const NoiseModel found = diagnose_noise("laser1", measured, 1).model;
  ASSERT_TRUE(found.has_relative());
  const GoodnessOfFit reported = goodness_of_fit("laser1", measured, found, {}, BeamsOf::kLaserAtRest, 1);
  EXPECT_LT(reported.after.p_value, 1e-12);
  const FitTest worst = *std::ranges::min_element(reported.after.tests, {}, &FitTest::p_value);
  EXPECT_EQ(worst.quantity, "noise");
  EXPECT_EQ(worst.covariate, "beam");
  // The common deviation is √(4² + 8²) / √2 = 6.3 mm; the beams' deviate by −2.3 mm and +1.7 mm: 2.0 mm RMS.
  EXPECT_NEAR(worst.amplitude, 2.0e-3, 0.2e-3);
}

TEST(GoodnessOfFit, AcceptsACommonStepWithItsCurve) {
  Eigen::VectorXd jump = Eigen::VectorXd::Constant(kScans, -1e-3);
  jump.tail(kScans / 2).array() += 2e-3;
  const RangeErrors measured =
      shots(5, [&](Random& random, int, int scan) { return 4e-3 * standard(random) + jump[scan]; });
  const GoodnessOfFit reported = goodness_of_fit("laser1", measured, {}, jump, BeamsOf::kLaserAtRest, 1);
  EXPECT_LT(reported.before.p_value, 1e-6);
  const FitTest worst = *std::ranges::min_element(reported.before.tests, {}, &FitTest::p_value);
  EXPECT_EQ(worst.quantity, "range");
  EXPECT_EQ(worst.covariate, "time");
  EXPECT_NEAR(worst.amplitude, 1e-3, 0.25e-3);  // three standard errors: 50 means of 0.5 mm
  EXPECT_GT(reported.after.p_value, 0.05);
}

TEST(GoodnessOfFit, RejectsAutocorrelatedRanges) {
  double last = 0;
  const RangeErrors measured =
      shots(6, [&](Random& random, int, int) { return last = 0.2 * last + 4e-3 * standard(random); });
  const FitStatistics reported = goodness_of_noise_model(measured, {}, {}, BeamsOf::kLaserAtRest, 1);
  EXPECT_LT(reported.p_value, 1e-6);
  const FitTest worst = *std::ranges::min_element(reported.tests, {}, &FitTest::p_value);
  EXPECT_EQ(worst.covariate, "next scan");
  EXPECT_NEAR(worst.amplitude, 0.2, 0.05);
}

TEST(GoodnessOfFit, TestsASingleBeam) {
  RangeErrors measured = shots(8, plain_error);
  std::ranges::fill(measured.beam, std::uint16_t{0});
  EXPECT_GT(goodness_of_noise_model(measured, {}, {}, BeamsOf::kSurfaces, 1).p_value, 0.05);
}

TEST(GoodnessOfFit, SimulatesQuantization) {
  constexpr double kStep = 8e-3;  // two standard deviations
  const FitStatistics reported =
      goodness_of_noise_model(shots(7, plain_error, kStep), {}, {}, BeamsOf::kLaserAtRest, 1);
  EXPECT_GT(reported.p_value, 0.05);
}

TEST(GoodnessOfFit, ReportsEachUnexplainedDeviationOnce) {
  const FitStatistics left{.tests = {{"remission", "range", "m", 0.0028, 1e-30},
                                     {"next beam", "correlation", "1", 0.18, 1e-20},
                                     {"beam", "noise", "m", 0.002, 1e-9},
                                     {"time", "noise", "m", 0.001, 0.05}},
                           .p_value = 1e-30};
  Findings all;
  all.unnamed = {{.covariate = "beam", .quantity = "noise", .scope = "laser1"}};
  add_left_over("laser1", left, 3, all);
  ASSERT_EQ(all.unnamed.size(), 3U) << "noise by beam is already reported, and one test is insignificant";
  EXPECT_EQ(all.unnamed[1].covariate, "remission");
  EXPECT_EQ(all.unnamed[1].amplitude, 0.0028);
  EXPECT_EQ(all.unnamed[2].covariate, "next beam");
  EXPECT_EQ(all.unnamed[2].unit, "1");
  EXPECT_NE(headline(all.unnamed[2]).find("correlation of laser1 depends on next beam, by 0.180"),
            std::string::npos);
  EXPECT_FALSE(all.unnamed[2].accepted);
}

}  // namespace
}  // namespace crisp
