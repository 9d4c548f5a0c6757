// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/distinct_profiles.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "plugins/diagnose/model/mean_residuals.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;

constexpr double kResidualSigma = 0.01;  // [m] noise of a residual
constexpr std::uint32_t kBeamsPerLaser = 6000;
constexpr std::size_t kLaserCount = 3;
constexpr double kTests = 30;

struct Beam {
  double mirror, time,
      incidence;  ///< the incidence follows the mirror angle, but for a quarter of its spread
  std::size_t laser;
};

/// Profiles of three lasers over three covariates, whose residuals are noise and `deviation`.
std::vector<Profile> profiles_with(const std::function<double(const Beam&)>& deviation) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Beam> beams;
  WeightedResiduals residuals;
  for (std::size_t laser = 0; laser < kLaserCount; ++laser) {
    for (std::uint32_t k = 0; k < kBeamsPerLaser; ++k) {
      const double mirror = uniform(random);
      beams.push_back({mirror, uniform(random), mirror + 0.25 * normal(random), laser});
      residuals.value.push_back(deviation(beams.back()) + kResidualSigma * normal(random));
      residuals.weight.push_back(1);
    }
  }
  std::vector<QuantileBins> layouts;
  std::vector<Profile> profiles;
  const auto add = [&](const std::string& covariate, std::size_t laser, double Beam::*value) {
    std::vector<std::uint32_t> members;
    std::vector<double> values;
    for (std::uint32_t k = 0; k < beams.size(); ++k) {
      if (beams[k].laser != laser) continue;
      members.push_back(k);
      values.push_back(beams[k].*value);
    }
    layouts.push_back(quantile_bins(members, values, [](double) { return std::size_t{0}; }));
    QuantileBins& layout = layouts.back();
    layout.profile.covariate = covariate;
    layout.profile.laser = laser;
    layout.profile.share = 1.0 / kLaserCount;
    const auto means = means_in(layout, residuals);
    const std::vector<double> errors(means.size(),
                                     kResidualSigma * std::sqrt(double(means.size()) / kBeamsPerLaser));
    profiles.push_back(layout.profile);
    for (std::size_t b = 0; b < means.size(); ++b) profiles.back().bins[b].error = errors[b];
    profiles.back().rms = systematic_rms(means, errors);
    profiles.back().p_value = profile_p_value(layout, means, errors);
  };
  for (std::size_t laser = 0; laser < kLaserCount; ++laser) {
    add("mirror angle", laser, &Beam::mirror);
    add("incidence", laser, &Beam::incidence);
    add("time", laser, &Beam::time);
  }
  mark_shadows(profiles, layouts, residuals, kTests);
  return profiles;
}

/// Significant profiles that are no shadows: "1 over time", "all over time".
std::vector<std::string> distinct(const std::vector<Profile>& profiles) {
  std::vector<std::string> names;
  for (const Profile& one : profiles) {
    if (!one.is_significant() || one.is_shadow) continue;
    names.push_back((one.is_common ? "all" : std::to_string(one.laser)) + " over " + one.covariate);
  }
  return names;
}

using testing::Each, testing::ElementsAre, testing::IsEmpty, testing::UnorderedElementsAre;

TEST(DistinctProfiles, AreNoneWithoutADeviation) {
  EXPECT_THAT(distinct(profiles_with([](const Beam&) { return 0.0; })), IsEmpty());
}

TEST(DistinctProfiles, LeaveOutTheShadowOverACorrelatedCovariate) {
  const auto over_mirror = [](const Beam& beam) {
    return beam.laser == 1 ? 0.005 * std::sin(3 * beam.mirror) : 0.0;
  };
  const auto profiles = profiles_with(over_mirror);
  EXPECT_TRUE(profiles[4].is_significant()) << "over the incidence";
  EXPECT_THAT(distinct(profiles), ElementsAre("1 over mirror angle"));
}

TEST(DistinctProfiles, KeepTwoDeviationsOfOneLaser) {
  const auto two = [](const Beam& beam) {
    return beam.laser == 2 ? 0.005 * std::sin(3 * beam.mirror) + 0.003 * beam.time : 0.0;
  };
  EXPECT_THAT(distinct(profiles_with(two)), UnorderedElementsAre("2 over mirror angle", "2 over time"));
}

TEST(DistinctProfiles, AreCommonWhereAllLasersDeviateInTime) {
  const auto in_time = [](const Beam& beam) {
    return (beam.laser == 1 ? -0.004 : 0.003) * std::sin(4 * beam.time);
  };
  const auto names = distinct(profiles_with(in_time));
  EXPECT_EQ(names.size(), kLaserCount);
  EXPECT_THAT(names, Each("all over time"));
}

TEST(DistinctProfiles, AreNotCommonWhereOneLaserStaysWithout) {
  const auto in_time = [](const Beam& beam) { return beam.laser == 1 ? 0.0 : 0.004 * beam.time; };
  EXPECT_THAT(distinct(profiles_with(in_time)), UnorderedElementsAre("0 over time", "2 over time"));
}

TEST(DistinctProfiles, AreNotCommonOverTheMirrorAngle) {
  const auto over_mirror = [](const Beam& beam) { return 0.004 * std::sin(3 * beam.mirror); };
  EXPECT_THAT(distinct(profiles_with(over_mirror)),
              UnorderedElementsAre("0 over mirror angle", "1 over mirror angle", "2 over mirror angle"));
}

}  // namespace
}  // namespace crisp
