// SPDX-License-Identifier: BSD-3-Clause
// Joint occlusion of many directions is distinguished from flicker and from the outlines of static objects.
#include "plugins/diagnose/scene/visibility.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace crisp {
namespace {

using namespace crisp::diagnose;

constexpr double kRepeat = 0.02;  // [s] from scan to scan
constexpr int kTwoDegrees = 4;    // beams

/// Beams of one laser towards a wall, of which those with is_hidden(plate angle, mirror angle, time) end one
/// metre before it.
ChangingDirections changing(double turns, double duration,
                            const std::function<bool(double, double, double)>& is_hidden) {
  const auto angle = [&](double t) {  // at a rate that varies, as turns of a whole number of scans repeat
    return 2 * std::numbers::pi * turns / duration * (t + 0.3 * std::sin(t));
  };
  std::vector<double> times, angles;
  for (double t = -0.1; t < duration + 0.1; t += 0.005) {
    times.push_back(t);
    angles.push_back(angle(t));
  }
  Measurements beams;
  BeamAssociation association;
  for (double t = 0; t < duration; t += kRepeat) {
    for (int beam = 0; beam < 30 * kTwoDegrees; ++beam) {
      const double mirror = (beam + 0.5) * std::numbers::pi / 180 * 2 / kTwoDegrees;
      beams.range.push_back(3);
      beams.mirror_angle.push_back(static_cast<float>(mirror));
      beams.time.push_back(t);
      beams.laser.push_back(0);
      beams.beam.push_back(static_cast<std::uint16_t>(beam));
      association.ahead.push_back(1);
      association.error.push_back(is_hidden(std::fmod(angle(t), 2 * std::numbers::pi), mirror, t) ? -1 : 0);
    }
  }
  return changing_directions(beams, PlateTrajectory(0, times, angles, 0.1), association, 0.008);
}

/// Widths and distances of static poles, in radians of the plate's angle.
struct Poles {
  double width, distance;
};

class ChangingDirectionsOf : public testing::TestWithParam<double> {};  // turns in ten seconds

TEST_P(ChangingDirectionsOf, StaticObjectsAreNone) {
  for (const Poles& poles : {Poles{0.03, 0.31}, Poles{0.08, 0.31}, Poles{0.13, 0.47}, Poles{0.3, 0.97}}) {
    const auto directions = changing(GetParam(), 10, [&](double plate, double mirror, double) {
      return std::fmod(plate + 0.05 * mirror, poles.distance) < poles.width;
    });
    EXPECT_FALSE(moving(directions, 1)) << poles.width << " rad wide";
  }
}

TEST_P(ChangingDirectionsOf, APersonWhoPassesIsFound) {
  const auto directions = changing(GetParam(), 10, [](double plate, double mirror, double time) {
    return std::abs(plate - 1 - 0.2 * time) < 0.25 && mirror > 0.2 && mirror < 0.9;
  });
  EXPECT_TRUE(moving(directions, 1)) << directions.views.size() << " directions";
}

INSTANTIATE_TEST_SUITE_P(Turns, ChangingDirectionsOf, testing::Values(2.1, 5.3, 15.1));

TEST(ChangingDirections, DistinguishJointOcclusionFromIndependentOnes) {
  std::mt19937_64 random(1);
  constexpr std::size_t kTimes = 12, kDirections = 30;
  const auto directions = [&](bool at_once) {
    ChangingDirections all;
    for (std::size_t k = 0; k < kDirections; ++k) {
      std::vector<Visibility> views(kTimes, Visibility::kSurface);
      for (std::size_t h = 0; h < 3; ++h) views[at_once ? 4 + h : random() % kTimes] = Visibility::kHidden;
      all.views.push_back(views);
      if (k > 0) all.neighbours.emplace_back(k - 1, k);
    }
    return all;
  };
  EXPECT_LT(p_value(directions(true), 1), 0.002);
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) named += moving(directions(false), seed) ? 1 : 0;
  EXPECT_LE(named, 1);
}

}  // namespace
}  // namespace crisp
