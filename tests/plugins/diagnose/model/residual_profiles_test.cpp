// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/residual_profiles.hpp"

#include <gmock/gmock.h>

#include <map>
#include <string>

#include "tests/plugins/diagnose/hidden.hpp"
#include "tests/support/several_recordings.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::quality;
using namespace crisp::simulate;

ProfileComparison given(const test::Recording& recording) {
  const SurfelSettings settings;
  const SurfaceObservations observations(SensorModel(recording.scanner.truth, built_in_terms()),
                                         recording.sample(), {.surfels = settings}, 60000);
  return compare_with_simulation(observations, settings, 1);
}

TEST(ProfileComparison, HasNoDeviationUnderTheTrueModel) {
  // Binned by measured range, noise would bend the profile over range by millimetres.
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ProfileComparison left = given(test::hidden(seed, 3, office(), {}));
    EXPECT_GT(left.p_value, 0.01) << seed;
    // Four standard errors of a median of 20 000 residuals' sizes.
    for (const double noise : left.noise) EXPECT_NEAR(noise, 0.012, 0.0004);
  }
}

TEST(ProfileComparison, FindsSurfacesWithTermsOfTheIncidence) {
  // Without the term, planes seen at grazing incidence are biased, and so are their incidence angles.
  const auto left =
      given(test::hidden(6, 5, built_in_scene("street"), {{"laser1.range.incidence", {-0.012, 0.156}}}));
  EXPECT_GT(left.p_value, 0.01);
}

TEST(ProfileComparison, SimulatesEachLaserWithNoiseOfItsOwn) {
  ScannerSettings scanner = test::scanner_of(5, 3);
  scanner.laser_effects.resize(3);
  scanner.laser_effects[1].noise.sigma = 0.005;
  const ProfileComparison left = given(test::recorded(scanner, office()));
  EXPECT_GT(left.p_value, 0.01) << "with common noise, laser 1 deviates as soon as its noise is larger";
  EXPECT_NEAR(left.noise.at(0), 0.012, 0.0002);
  EXPECT_NEAR(left.noise.at(1), 0.005, 0.0002);
}

TEST(ProfileComparison, SimulatesEachBeamWithItsShareOfTheNoise) {
  ScannerSettings scanner = test::scanner_of(5, 4);
  scanner.laser_effects.resize(3);
  scanner.laser_effects[1].noise.slope = 0.006;
  scanner.laser_effects[2].noise.spread = 0.030;
  const ProfileComparison left = given(test::recorded(scanner, office()));
  EXPECT_GT(left.p_value, 0.01) << "with common noise, the means of noisy bins exceed their errors";
}

TEST(ProfileComparison, ShowsADeviationOverItsCovariate) {
  test::Recording recording = test::hidden(4, 3, office(), {});
  for (std::size_t i = 0; i < recording.made.beams.size(); ++i) {
    if (recording.made.beams.laser[i] != 2) continue;
    recording.made.beams.range[i] += 0.004F * std::sin(2 * recording.made.beams.mirror_angle[i]);
  }
  const ProfileComparison left = given(recording);
  EXPECT_LT(left.p_value, 0.01);
  const auto largest = std::ranges::max_element(left.profiles, {}, &Profile::rms);
  EXPECT_EQ(largest->laser, 2U);
  EXPECT_EQ(largest->covariate, "mirror angle");
  EXPECT_NEAR(largest->rms, 0.004 / std::sqrt(2), 0.002) << "less what the planes absorb";
}

TEST(ProfileComparison, ShowsDisagreementOfFrontAndBack) {
  test::Recording recording = test::hidden(5, 3, office(), {});
  for (std::size_t i = 0; i < recording.made.beams.size(); ++i) {
    const bool is_back = recording.made.beams.mirror_angle[i] > 0;
    if (recording.made.beams.laser[i] == 1 && is_back) recording.made.beams.range[i] += 0.004F;
  }
  const ProfileComparison left = given(recording);
  const auto halves = std::ranges::find_if(left.profiles, [](const Profile& profile) {
    return profile.covariate == "front/back" && profile.laser == 1;
  });
  ASSERT_NE(halves, left.profiles.end());
  ASSERT_EQ(halves->bins.size(), 2U);
  EXPECT_EQ(halves->bins[0].at, 0);
  EXPECT_EQ(halves->bins[1].at, 1);
  EXPECT_LT(halves->p_value, 1e-4) << "below the smallest rank p-value of 199 simulations";
  EXPECT_GT(halves->bins[1].measured - halves->bins[0].measured, 0.001);
}

TEST(ProfileComparison, ShowsARangeOffsetOfOneLaser) {
  test::Recording recording = test::hidden(6, 3, office(), {});
  for (std::size_t i = 0; i < recording.made.beams.size(); ++i) {
    if (recording.made.beams.laser[i] == 1) recording.made.beams.range[i] += 0.006F;
  }
  const ProfileComparison left = given(recording);
  const auto lasers = std::ranges::find(left.profiles, "laser", &Profile::covariate);
  ASSERT_NE(lasers, left.profiles.end());
  EXPECT_EQ(lasers->laser, kAllLasers);
  ASSERT_EQ(lasers->bins.size(), 3U);
  EXPECT_TRUE(lasers->is_significant());
  EXPECT_EQ(lasers->bins[1].at, 2) << "lasers count from 1";
  for (const std::size_t other : {0U, 2U}) {
    EXPECT_GT(lasers->bins[1].measured - lasers->bins[other].measured, 0.002) << other;
  }
}

TEST(ProfileComparison, EstimatesTheExcessOverNoise) {
  const ProfileComparison clean = given(test::hidden(6, 3, office(), {}));
  EXPECT_NEAR(clean.excess, 0, 1.9e-6) << "standard error 0.6 mm^2 for 60 000 ranges of 144 mm^2 noise";
  ScannerSettings scanner = test::scanner_of(6, 3);
  scanner.laser_effects.resize(3);
  scanner.laser_effects[1].noise.sigma = 0.024;
  EXPECT_NEAR(given(test::recorded(scanner, office())).excess, 0, 4.8e-6) << "1.6 mm^2 for any noise";
  test::Recording recording = test::hidden(6, 3, office(), {});
  for (std::size_t i = 0; i < recording.made.beams.size(); ++i) {
    recording.made.beams.range[i] += 0.008F * std::sin(4 * recording.made.beams.mirror_angle[i]);
  }
  const double most = 0.5 * 0.008 * 0.008;
  EXPECT_GT(given(recording).excess, 0.5 * most) << "less what the planes absorb";
  EXPECT_LT(given(recording).excess, 1.1 * most);
}

TEST(ProfileComparison, SumsUnexplainedSquaresOverLasersByCovariate) {
  using testing::ElementsAre, testing::Pair, testing::DoubleNear;
  const auto profile = [](const char* covariate, std::size_t laser, double rms, double p_value) {
    return Profile{.covariate = covariate,
                   .unit = "",
                   .laser = laser,
                   .bins = {},
                   .share = 0.25,
                   .rms = rms,
                   .p_value = p_value};
  };
  const auto squares = [](double square) { return DoubleNear(square, 1e-12); };
  ProfileComparison left;
  EXPECT_TRUE(left.unexplained().empty());
  left.profiles = {profile("time", 0, 0.002, 1e-9), profile("time", 1, 0.004, 1e-9),
                   profile("range", 0, 0.003, 1e-9), profile("range", 1, 0.030, 0.02)};
  EXPECT_THAT(left.unexplained(),
              ElementsAre(Pair("range", squares(0.25 * 9e-6)), Pair("time", squares(0.25 * 20e-6))))
      << "without profiles that are not significant";
  EXPECT_THAT(left.unexplained(1), ElementsAre(Pair("time", squares(0.25 * 16e-6))));
  EXPECT_TRUE(left.unexplained(2).empty()) << "no deviation of its ranges";
  left.profiles.push_back(profile("laser", kAllLasers, 0.001, 1e-9));
  EXPECT_THAT(left.unexplained(2), ElementsAre(Pair("laser", squares(0.25 * 1e-6))))
      << "deviation between lasers";
}

TEST(ProfileComparison, HasTheShareOfBeamsInEachProfile) {
  const ProfileComparison left = given(test::hidden(4, 3, office(), {}));
  std::map<std::string, double> shares;
  for (const Profile& profile : left.profiles) shares[profile.covariate] += profile.share;
  ASSERT_TRUE(shares.contains("time") && shares.contains("laser"));
  for (const auto& [covariate, share] : shares) EXPECT_NEAR(share, 1, 1e-9) << covariate;
}

TEST(ProfileComparison, HasNoBinOverTimeAcrossAPause) {
  const test::Recording longer = test::hidden(3, 3, office(), {}), shorter = test::hidden(4, 1, office(), {});
  const test::Several both = test::several({longer.made, shorter.made});
  const SurfelSettings settings;
  const SurfaceObservations observations(SensorModel(longer.scanner.truth, built_in_terms()), both.sample(),
                                         {.surfels = settings}, 60000);
  const ProfileComparison left = compare_with_simulation(observations, settings, 1);
  EXPECT_GT(left.p_value, 0.01);
  const auto over_time = std::ranges::find(left.profiles, "time", &Profile::covariate);
  ASSERT_NE(over_time, left.profiles.end());
  std::map<std::size_t, std::size_t> bins;
  for (const Profile::Bin& bin : over_time->bins) {
    ++bins[bin.recording];
    const double later = bin.recording == 0 ? 0 : 60;
    const PlateTrajectory& own = (bin.recording == 0 ? longer : shorter).made.plate;
    EXPECT_GT(bin.at, own.begin() + later);
    EXPECT_LT(bin.at, own.end() + later);
  }
  EXPECT_THAT(bins,
              testing::ElementsAre(testing::Pair(0, testing::Ge(8U)), testing::Pair(1, testing::Ge(2U))));
}

TEST(ProfileComparison, ComparesDistributionsWithSimulatedOnes) {
  test::Recording recording = test::hidden(4, 3, office(), {});
  for (std::size_t i = 0; i < recording.made.beams.size(); ++i) {
    if (recording.made.beams.laser[i] != 2) continue;
    recording.made.beams.range[i] += 0.012F * std::sin(6 * recording.made.beams.mirror_angle[i]);
  }
  const ProfileComparison left = given(recording);
  ASSERT_EQ(left.distributions.size(), 3U);
  for (const Distribution& one : left.distributions) {
    EXPECT_NEAR(one.simulated_rms, 1, 0.02) << "less the few degrees of freedom of the planes";
  }
  for (const std::size_t other : {0U, 1U}) {
    EXPECT_NEAR(left.distributions[other].measured_rms, 1, 0.05) << "distortion of the planes";
  }
  EXPECT_GT(left.distributions[2].measured_rms, 1.1) << "up to sqrt(1 + 1 / 2), less what the planes absorb";
}

TEST(ProfileComparison, HasUniformPValuesUnderPlainNoise) {
  constexpr std::size_t kRecordings = 16;
  std::vector<double> p_values;
  for (std::uint64_t seed = 11; seed < 11 + kRecordings; ++seed) {
    p_values.push_back(given(test::hidden(seed, 2, office(), {})).p_value);
  }
  std::ranges::sort(p_values);
  double furthest = 0;
  for (std::size_t k = 0; k < kRecordings; ++k) {
    const double below = static_cast<double>(k) / kRecordings;
    furthest = std::max({furthest, below + 1.0 / kRecordings - p_values[k], p_values[k] - below});
  }
  EXPECT_LT(furthest, 1.63 / std::sqrt(kRecordings)) << "1 % critical value (Kolmogorov)";
}

}  // namespace
}  // namespace crisp
