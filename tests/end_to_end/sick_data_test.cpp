// SPDX-License-Identifier: BSD-3-Clause
// Systematic errors of stationary SICK lasers that the plain simulator lacks, identified by
// configs/real/sick.yaml. The figures are those of an independent evaluation of the same recordings. Skipped
// where they are not at hand.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/end_to_end/real_data.hpp"

namespace crisp {
namespace {

class SickData : public test::OnRealData {
 protected:
  std::vector<std::string> accepted() const {
    std::vector<std::string> causes;
    for (const auto& finding : diagnosis_["findings"]) {
      if (finding["accepted"]) causes.push_back(finding["cause"]);
    }
    return causes;
  }
  bool has_unnamed(const std::string& covariate) const {
    return std::ranges::any_of(diagnosis_["unnamed"],
                               [&](const auto& unnamed) { return unnamed["covariate"] == covariate; });
  }
  /// A parameter of a cause, "value" or "std_error".
  double number(const std::string& cause, const std::string& parameter, const char* which = "value") const {
    const auto found = finding(cause);
    if (!found.is_object()) return std::numeric_limits<double>::quiet_NaN();
    for (const auto& p : found["parameters"]) {
      if (p["name"] == parameter) return p[which];
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
};

TEST_F(SickData, AnLms111TurnsSlowlyJumpsAndScattersAboutTwoValues) {
  if (!run("sick.yaml", "sick/lms111-20210302-colab-rebuilt.pcap")) return;
  EXPECT_THAT(accepted(), testing::UnorderedElementsAre("mirror.period", "range.step", "noise.two_peaks"));
  EXPECT_NEAR(number("mirror.period", "excess"), 114.5e-6, 1e-6);  // 20 114.5 us for 20 000
  // 23.6 standard errors, by 21 pieces: (23.6² − ln 21) / 2 ln 10.
  EXPECT_NEAR(double{finding("mirror.period")["log10_bayes_factor"]}, 120, 2);
  EXPECT_NEAR(number("range.step", "h"), -2.05e-3, 3 * number("range.step", "h", "std_error"));
  EXPECT_GT(number("noise.two_peaks", "separation"), 13.5e-3);
  EXPECT_LT(number("noise.two_peaks", "separation"), 16.7e-3);
  for (const auto& finding : diagnosis_["findings"]) {
    const std::string cause = finding["cause"];
    if (cause == "mirror.period") continue;  // nothing is held out
    const auto& ci95 = finding["gain"][0]["ci95"];
    EXPECT_GT(cause == "noise.two_peaks" ? double{ci95[0]} : -double{ci95[1]}, 0) << cause;
  }
  EXPECT_LT(diagnosis_["goodness_of_fit"]["before_p"], 1e-100);
  EXPECT_LT(diagnosis_["goodness_of_fit"]["after_p"], 1e-6) << "of what each beam does for itself";
  for (const auto& departure : diagnosis_["departures"]) {
    EXPECT_LT(departure["amplitude_after"], departure["amplitude"]) << departure["covariate"];
  }
}

TEST_F(SickData, AnLms111AnswersToWhatIsInjected) {
  const std::string put_in =
      "{mirror.period: {excess: 20us}, latency.step: {by: 1ms, at: 1.7s}, noise.normal: {sigma: 5mm}}";
  if (!run("answers.yaml", "sick/lms111-20210302-colab-rebuilt.pcap", {"simulate.inject.effects=" + put_in}))
    return;
  EXPECT_NEAR(number("mirror.period", "excess"), 114.5e-6 + 20e-6, 1e-6);
  EXPECT_NEAR(number("latency.step", "by"), 1e-3, 4 * number("latency.step", "by", "std_error"));
  const nlohmann::json gain = finding("mirror.period")["gain"][0];
  EXPECT_NEAR(gain["before"], 119.6e-6 + 20e-6, 1e-6) << "119.6 us of its own";
  const nlohmann::json noise = finding("noise.two_peaks")["gain"][0];
  // 3.434 nat for 7.81 mm (RMS) of its own, and an injected 5 mm.
  EXPECT_NEAR(noise["before"], 3.434 - std::log(std::hypot(7.81, 5) / 7.81), 0.01);
}

TEST_F(SickData, ATim781KeepsItsRateAndItsNoiseHasOnePeak) {
  if (!run("sick.yaml", "sick/tim781s-20210106-colab.pcapng")) return;
  const auto causes = accepted();
  EXPECT_THAT(causes, testing::Not(testing::Contains("noise.two_peaks")));
  EXPECT_THAT(causes, testing::Not(testing::Contains("mirror.period")));
  ASSERT_EQ(diagnosis_["devices"].size(), 1U);
  const auto& device = diagnosis_["devices"][0];
  EXPECT_NEAR(device["period"], 66'666.3e-6, 3 * double{device["period_std_error"]});
  EXPECT_NEAR(device["skew"], 4.5e-6, 2e-6);
  EXPECT_TRUE(has_unnamed("beam")) << "targets differ, and so does what is scattered";
  EXPECT_TRUE(has_unnamed("time")) << "apart from the step ranges wander";
}

TEST_F(SickData, AnLms511BeforeWhichSomebodyMovesIsGivenNoJump) {
  for (const std::string day : {"20210301", "20210302"}) {
    if (!run("telegrams.yaml", "sick/lms511-" + day + "-colab.json")) return;
    EXPECT_THAT(accepted(), testing::ElementsAre("scene.moving")) << day << ": no tails by moving people";
    EXPECT_TRUE(has_unnamed("time")) << "0.3 mm within 5 s, by an independent evaluation";
    EXPECT_TRUE(has_unnamed("beam"));
    const auto& device = diagnosis_["devices"].at(0);
    EXPECT_NEAR(device["period"], 40'001e-6, 3 * double{device["period_std_error"]});
    EXPECT_NEAR(double{device["skew"]}, 5e-6, 3 * double{device["skew_std_error"]})
        << "3 and 7 ppm by that evaluation";
    EXPECT_NEAR(double{device["delay_median"]}, 53.5e-6, 12e-6) << "44 to 63 us";
    EXPECT_NEAR(double{device["delay_95"]}, 158e-6, 40e-6) << "127 to 190 us";
  }
}

}  // namespace
}  // namespace crisp
