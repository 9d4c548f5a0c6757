// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/bursts.hpp"

#include <gtest/gtest.h>

#include <random>

#include "plugins/diagnose/scans/scan_prediction_errors.hpp"
#include "tests/plugins/diagnose/scans/tilting_scene.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;

constexpr double kPeriod = test::TiltingScene::kPeriod;

TEST(Bursts, AreFoundInScansThatArriveInPairs) {
  std::vector<double> receipts, stamps;
  for (int i = 0; i < 200; ++i) {
    stamps.push_back(kPeriod * i);
    receipts.push_back(kPeriod * (i - i % 2) + 0.03 + 0.001 * (i % 2));
  }
  const Bursts bursts = find_bursts(receipts, stamps, 1);
  EXPECT_NEAR(bursts.interval, kPeriod, 1e-9);
  EXPECT_NEAR(bursts.together, 0.5, 0.01);
  EXPECT_LT(bursts.p_value, 0.01);
}

TEST(Bursts, AreFoundInScansThatArriveAfterStalls) {
  std::mt19937_64 random(5);
  std::exponential_distribution<double> length(1 / 0.06);
  std::vector<double> receipts, stamps;
  double end = 0;
  for (int i = 0; i < 200; ++i) {
    stamps.push_back(kPeriod * i);
    while (end < stamps.back()) end += length(random);  // consecutive stalls
    receipts.push_back(end + 1e-4 * i / 200);
  }
  const Bursts bursts = find_bursts(receipts, stamps, 1);
  EXPECT_NEAR(bursts.together, std::exp(-kPeriod / 0.06), 0.1);
  EXPECT_LT(bursts.p_value, 0.01);
}

TEST(Bursts, AreNotFoundInIndependentDelays) {
  std::mt19937_64 random(3);
  std::exponential_distribution<double> delay(1 / 0.004);
  int found = 0;
  for (int run = 0; run < 50; ++run) {
    std::vector<double> receipts, stamps;
    for (int i = 0; i < 200; ++i) {
      stamps.push_back(kPeriod * i);
      receipts.push_back(stamps.back() + delay(random));
    }
    if (find_bursts(receipts, stamps, 1).p_value < 0.01) ++found;
  }
  EXPECT_LE(found, 3) << "expected: 0.5 of 50";
}

/// A sweep of 60°/s with evenly taken scans.
struct EvenSweep {
  explicit EvenSweep(double noise) {
    test::TiltingScene scene(noise);
    for (std::uint16_t i = 0; i < 90; ++i) {
      const double time = kPeriod * i;
      const double tilt = 20 * kDegree + 60 * kDegree * time;
      series.add(test::reading_at(tilt, time));
      series.add(scene.scan(tilt, 20 * kDegree, 140, i, time));
      times.push_back(time);
      angles.push_back(20 * kDegree);
    }
  }
  double median(const std::vector<double>& when) const {
    return scan_prediction_errors(series.scans(), when, angles,
                                  series.actuator({.counts_per_revolution = 360000}))
        .median();
  }
  ScanSeries series;
  std::vector<double> times, angles;
};

TEST(ScanPredictionErrors, OfCorrectlyTimedScansAreNoise) {
  constexpr double kNoise = 0.005;
  const EvenSweep sweep(kNoise);
  // Normal value less the mean of two: the median absolute value is 0.674 · √1.5 σ.
  EXPECT_NEAR(sweep.median(sweep.times), 0.674 * std::sqrt(1.5) * kNoise, 0.15 * kNoise);
}

TEST(ScanPredictionErrors, OfBurstTimedScansExceedNoise) {
  const EvenSweep sweep(0.005);
  auto bunched = sweep.times;
  for (std::size_t i = 1; i < bunched.size(); i += 2) bunched[i] = bunched[i - 1] + 0.001;
  EXPECT_GT(sweep.median(bunched), 4 * sweep.median(sweep.times));
}

TEST(ScanPredictionErrors, HardlyRespondToACommonLag) {
  const EvenSweep sweep(0.005);
  auto late = sweep.times;
  for (double& time : late) time -= 0.02;
  EXPECT_NEAR(sweep.median(late), sweep.median(sweep.times), 0.1 * sweep.median(sweep.times));
}

}  // namespace
}  // namespace crisp
