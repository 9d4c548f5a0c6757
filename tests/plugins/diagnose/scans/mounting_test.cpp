// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/mounting.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;

/// Ranges from an optical centre off the tilt axis in a box of 4 x 6 x 8 m, by intersection with its six
/// planes.
class BoxSweep {
 public:
  BoxSweep(double along_beam, double along_normal, double range_offset, double noise, std::uint64_t seed = 5,
           int scans = 300) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, noise);
    for (int i = 0; i < scans; ++i) {
      const double tilt = 0.3 * i * kDegree;
      const Eigen::Vector3d away(std::cos(tilt), std::sin(tilt), 0),
          across(-std::sin(tilt), std::cos(tilt), 0);
      const Eigen::Vector3d centre = along_beam * away + along_normal * across;
      std::vector<float> ranges;
      for (int k = 0; k < 170; ++k) {
        const double mirror = (5 + k) * kDegree;
        const Eigen::Vector3d ray = std::sin(mirror) * away - std::cos(mirror) * Eigen::Vector3d::UnitZ();
        double best = 100;
        const Eigen::Vector3d half(2.2, 2.8, 4.1);
        for (int axis = 0; axis < 3; ++axis) {
          for (const double side : {-1.0, 1.0}) {
            const double r = (side * half(axis) - centre(axis)) / ray(axis);
            if (r > 0 && r < best) best = r;
          }
        }
        ranges.push_back(static_cast<float>(best - range_offset + normal(random)));
      }
      ranges_.push_back(std::move(ranges));
    }
    for (int i = 0; i < scans; ++i)
      pass_.scans.push_back({0.3 * i * kDegree, &ranges_[static_cast<std::size_t>(i)]});
  }
  const Pass& pass() const { return pass_; }

 private:
  std::vector<std::vector<float>> ranges_;
  Pass pass_;
};

constexpr FanGeometry kFan{.first = 5 * kDegree, .step = kDegree};

TEST(Mounting, IsEstimatedWithinItsErrorsInABox) {
  const BoxSweep sweep(0.08, -0.055, 0, 0.01);
  const auto windows = flat_windows(sweep.pass(), kFan, 20 * kDegree);
  ASSERT_GT(windows.size(), 6U);
  const auto fit = fit_mounting(windows, {}, {kAlongBeam, kAlongNormal}, 1);
  EXPECT_NEAR(fit.values[kAlongBeam], 0.08, 4 * fit.std_errors[kAlongBeam]);
  EXPECT_NEAR(fit.values[kAlongNormal], -0.055, 4 * fit.std_errors[kAlongNormal]);
  EXPECT_LT(fit.std_errors[kAlongBeam], 0.1);
  EXPECT_NEAR(fit.rms, 0.01, 0.003) << "the residual is noise";
}

TEST(Mounting, IsEstimatedJointlyWithARangeOffset) {
  const BoxSweep sweep(0.08, 0, 0.04, 0.002);
  const auto windows = flat_windows(sweep.pass(), kFan, 10 * kDegree);
  const auto both = fit_mounting(windows, {}, {kAlongBeam, kAlongNormal, kRangeOffset}, 1);
  EXPECT_NEAR(both.values[kAlongBeam], 0.08, 4 * both.std_errors[kAlongBeam]);
  EXPECT_NEAR(both.values[kRangeOffset], 0.04, 4 * both.std_errors[kRangeOffset]);
  const auto alone = fit_mounting(windows, {}, {kAlongBeam, kAlongNormal}, 1);
  EXPECT_LT(alone.std_errors[kAlongBeam], both.std_errors[kAlongBeam])
      << "a further free parameter increases the errors";
}

/// A third of a turn constrains the mounting poorly, and its errors must show that.
TEST(Mounting, HasHonestErrorsForAShortSweep) {
  constexpr int kSeeds = 20;
  std::array<double, 2> squares{};
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const BoxSweep sweep(0.08, -0.055, 0, 0.005, seed, 110);
    const auto windows = flat_windows(sweep.pass(), kFan, 12 * kDegree);
    ASSERT_GT(windows.size(), 6U);
    const auto fit = fit_mounting(windows, {}, {kAlongBeam, kAlongNormal}, seed);
    squares[0] += std::pow((fit.values[kAlongBeam] - 0.08) / fit.std_errors[kAlongBeam], 2) / kSeeds;
    squares[1] += std::pow((fit.values[kAlongNormal] + 0.055) / fit.std_errors[kAlongNormal], 2) / kSeeds;
  }
  // χ² of 20 is below 45.3 in 99.9 % of cases; an error from some tens of windows is accurate to a fifth.
  EXPECT_LT(squares[0], 45.3 / kSeeds * 1.44);
  EXPECT_LT(squares[1], 45.3 / kSeeds * 1.44);
}

TEST(Mounting, RecoversAnInjectedError) {
  const BoxSweep sweep(0, 0, 0, 0.01);
  const auto windows = flat_windows(sweep.pass(), kFan, 15 * kDegree);
  const std::vector<MountingParameter> free = {kAlongBeam, kAlongNormal};
  const double before = fit_mounting(windows, {}, free, 1).values[kAlongBeam];
  const double after = fit_mounting(with_injected(windows, kAlongBeam, 0.03), {}, free, 1).values[kAlongBeam];
  EXPECT_NEAR(after - before, 0.03, 0.003);
}

TEST(Mounting, LeavesOutWindowsAcrossAnEdge) {
  const BoxSweep sweep(0, 0, 0, 0.005);
  for (const auto& window : flat_windows(sweep.pass(), kFan, 20 * kDegree)) {
    // Floor and wall meet at atan(2.8 / 2.2).
    const double edge = std::atan2(2.8, 2.2);
    const double first = window.sights.front().angle, last = window.sights.back().angle;
    EXPECT_FALSE(first < edge - 3 * kDegree && last > edge + 3 * kDegree &&
                 std::abs(window.sights.front().mirror - 90 * kDegree) < 30 * kDegree);
  }
}

}  // namespace
}  // namespace crisp
