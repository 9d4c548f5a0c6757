// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/pipeline/estimate/support.hpp"
#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::simulate;

const SimulatedMeasurements& recording() {
  static const auto kRecording = simulate_measurements(misplaced_scanner(1, 1.0), office());
  return kRecording;
}

TEST(Sample, InPlaneKeepsTheTwoBeamsAtNinetyDegrees) {
  const auto both = in_plane(sample_of(recording()), 0.0044, Half::kBoth);
  std::set<int> beams(both.beams.beam.begin(), both.beams.beam.end());
  EXPECT_EQ(beams, (std::set<int>{0, 360}));  // reported −45° and 135° at 0.5° a step
  const auto front = in_plane(sample_of(recording()), 0.0044, Half::kFront);
  EXPECT_EQ(std::set<int>(front.beams.beam.begin(), front.beams.beam.end()), std::set<int>{0});
}

TEST(Sample, KnowsWhichLasersSweep) {
  const Measurements beams{.range = {1, 1, 1, 1, 1},
                           .mirror_angle = {-1, 0.5, 0, 0.51, 2},
                           .time = {0, 1, 2, 3, 4},
                           .laser = {0, 2, 0, 2, 0},
                           .remission = {0, 0, 0, 0, 0},
                           .beam = {0, 0, 0, 0, 0},
                           .cos_incidence = {}};
  const auto sweeps = mirror_sweeps(beams);
  EXPECT_EQ(sweeps.size(), 2U);
  EXPECT_FLOAT_EQ(sweeps.at(0), 3);
  EXPECT_GT(sweeps.at(0), kLeastSweep);
  EXPECT_LT(sweeps.at(2), kLeastSweep);
}

TEST(Sample, CoveredLeavesOutWhatAnEtaInTheRangeWouldPushOffThePlatesReadings) {
  const auto& plate = recording().plate;
  const auto sample = covered(sample_of(recording()), -0.4, 0.3);
  ASSERT_GT(sample.beams.size(), 0U);
  EXPECT_GE(sample.beams.time.front() - 0.4, plate.begin());
  EXPECT_LE(sample.beams.time.back() + 0.3, plate.end());
  EXPECT_LT(sample.beams.size(), recording().beams.size());
}

TEST(Sample, PlaceableLeavesOutWhatATermOfTimePushesOffThePlatesReadings) {
  const auto sample = covered(sample_of(recording()), -0.1, 0.1);
  EXPECT_EQ(placeable(SensorModel(recording().truth), sample).beams.size(), sample.beams.size());
  Calibration late = recording().truth;
  TermParameters drift = neutral_parameters(built_in_terms().get("clock.drift")->info());
  drift.parameters[0].value = 0.01;
  // η ends with the readings but for 5 ms; the clock loses a hundredth, 8 ms in the end.
  late.lasers[0].terms.push_back(drift);
  const auto of_laser1 = of_laser(sample, 0).beams.time;
  late.lasers[0].eta.value = recording().plate.end() - std::ranges::max(of_laser1) - 0.005;
  const SensorModel model(late, built_in_terms());
  const auto placed = placeable(model, sample);
  EXPECT_LT(placed.beams.size(), sample.beams.size());
  EXPECT_EQ(model.place(placed.beams, *placed.plate).index.size(), placed.beams.size());
}

TEST(Sample, ThinningByAreaIsRepeatableAndEvensOutTheDensityAtTheSpinAxis) {
  const SensorModel model(recording().truth);
  const auto all = sample_of(recording());
  const auto thin = thin_by_area(all, model, 5000, 7);
  // A sum of independent draws: within five standard deviations of the requested count.
  EXPECT_NEAR(static_cast<double>(thin.beams.size()), 5000, 5 * std::sqrt(5000.0));
  EXPECT_EQ(thin.beams.time, thin_by_area(all, model, 5000, 7).beams.time);
  EXPECT_NE(thin.beams.time, thin_by_area(all, model, 5000, 8).beams.time);
  const auto near_axis = [&](const Sample& sample) {
    const auto points = model.place(sample.beams, *sample.plate).points;
    double n = 0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) n += points.col(i).head<2>().norm() < 0.5;
    return n / static_cast<double>(points.cols());
  };
  // Floor and ceiling within half a metre of the axis are 1.6 m² of some 250 m².
  EXPECT_GT(near_axis(all), 0.05);
  EXPECT_LT(near_axis(thin), 0.02);
}

TEST(Sample, JoinedTrajectoriesAreOne) {
  const auto piece = [](double from, double to) {
    std::vector<double> times, angles;
    for (double t = from; t < to; t += 0.01) {
      times.push_back(t);
      angles.push_back(3 * t);
    }
    return std::make_shared<const PlateTrajectory>(5, times, angles, 0.05);
  };
  const auto whole = joined({piece(0, 1), piece(0.5, 2)});
  EXPECT_EQ(whole.epoch_ns(), 5);
  EXPECT_LT(whole.begin(), 1e-9);
  EXPECT_GT(whole.end(), 1.98);
  EXPECT_NEAR(whole.at(1.005)->angle, 3.015, 1e-9);
}

TEST(Sample, TheSeamOfTwoPiecesHasTheRateOfThePlateWhateverTheirClocksDifferBy) {
  for (const double off : {1e-12, 1e-9, 1e-6, -1e-9, 2e-5}) {
    const auto piece = [](double from, double clock) {
      std::vector<double> times, angles;
      for (int k = 0; k < 500; ++k) {
        times.push_back(from + 0.002 * k + clock);
        angles.push_back(6 * (from + 0.002 * k));
      }
      return std::make_shared<const PlateTrajectory>(0, times, angles, 0.05);
    };
    const auto whole = joined({piece(0, 0), piece(0.5, off), piece(1, 2 * off)});
    EXPECT_EQ(whole.size(), 1000U) << off;
    for (const double rate : whole.rates()) EXPECT_NEAR(rate, 6, 0.1) << off;
  }
}

}  // namespace
}  // namespace crisp
