// SPDX-License-Identifier: BSD-3-Clause
// Recordings of one scanner in several places, taken together.
#include "tests/support/several_recordings.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <cmath>

#include "pipeline/data/recordings.hpp"
#include "pipeline/estimate/base_parameters.hpp"
#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/estimate/recording_lags.hpp"
#include "pipeline/estimate/shared_errors.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::estimate;
using namespace crisp::quality;
using namespace crisp::simulate;

/// The same scanner in office and hall.
std::vector<SimulatedMeasurements> in_two_places() {
  const auto first = misplaced_scanner(1, 2.0);
  auto second = misplaced_scanner(1, 2.0);
  second.motion.min_rate = 0.3;
  second.seed = 77;
  return {simulate_measurements(first, office()), simulate_measurements(second, hall())};
}

double chi2_of(const Refinement& refined, const Calibration& truth) {
  const auto& free = refined.outcome.free;
  const Eigen::VectorXd error = picked(refined.outcome.model, free) - picked(SensorModel(truth), free);
  return error.dot(refined.outcome.covariance.inverse() * error);
}

TEST(SeveralRecordings, DetermineMoreTogetherThanOneAlone) {
  const auto recordings = in_two_places();
  const test::Several all = test::several(recordings, true);
  const SensorModel truth(recordings[0].truth);
  const Refinement alone = refine_by_surfels(truth, sample_of(recordings[0]), {});
  const Refinement refined = refine_by_surfels(truth, all.sample(), {});
  EXPECT_TRUE(refined.converged);
  ASSERT_EQ(refined.outcome.free.size(), 11U);
  EXPECT_LT(chi2_of(refined, recordings[0].truth), 40) << "11 degrees of freedom: one case of 30 000";
  EXPECT_GT(refined.surfels, 1.5 * static_cast<double>(alone.surfels));
  const auto variance = [](const Refinement& of) { return of.outcome.covariance.diagonal().array(); };
  EXPECT_LT((variance(refined) / variance(alone)).mean(), 0.75) << "as much again: a half";
}

TEST(SeveralRecordings, StandFartherApartThanAnyBeamGoes) {
  const test::Several all = test::several(in_two_places());
  const SensorModel model(nominal_calibration(default_rig()));
  const Sample inside = covered(all.sample(), -0.1, 0.1);
  const PlacedBeams placed(model, inside);
  const RecordingNumbers number(all.plate);
  for (std::size_t i = 0; i < inside.beams.size(); ++i) {
    const double x = placed.view().points.x[i];
    ASSERT_EQ(std::llround(x / 1000), static_cast<long long>(number.of(inside.beams.time[i])));
  }
}

TEST(SeveralRecordings, AreAlignedEachByItself) {
  const test::Several all = test::several(in_two_places());
  Calibration turned = nominal_calibration(default_rig());
  const SensorModel model(turned);
  for (LaserCalibration& laser : turned.lasers) laser.lambda.value += 0.3;
  const Sample inside = covered(all.sample(), -0.1, 0.1);
  const PlacedBeams before(model, inside);
  PlacedBeams after(SensorModel(turned), inside);
  after.align_with(before, inside);
  const BeamsView to = before.view();
  const BeamsView moved = after.view();
  for (std::size_t i = 0; i < inside.beams.size(); ++i) {
    ASSERT_NEAR(moved.points.x[i], to.points.x[i], 1e-9);
    ASSERT_NEAR(moved.points.y[i], to.points.y[i], 1e-9);
    ASSERT_NEAR(moved.points.z[i], to.points.z[i], 1e-9);
    ASSERT_NEAR(moved.directions.x[i], to.directions.x[i], 1e-9);
    ASSERT_NEAR(moved.directions.y[i], to.directions.y[i], 1e-9);
  }
}

TEST(SeveralRecordings, HaveNoBlocksInTheirPauses) {
  const test::Several all = test::several(in_two_places());
  const auto blocks = recording_blocks(all.beams);
  const auto together = *std::ranges::max_element(blocks);
  EXPECT_LT(together, 50U) << "40 tenths of a second of recording, and what the borders cut";
  EXPECT_GT(together, 30U);
}

TEST(SeveralRecordings, TheLongestIsTheOneWithMostBeams) {
  auto recordings = in_two_places();
  recordings[0] = simulate_measurements(misplaced_scanner(1, 1.0), office());
  const test::Several all = test::several(recordings);
  const Sample longest = longest_recording(all.sample());
  EXPECT_EQ(longest.beams.size(), recordings[1].beams.size());
  EXPECT_EQ(longest.beams.range, recordings[1].beams.range);
}

TEST(SeveralRecordings, LagsOfTheirOwnAreFoundAndTakenAway) {
  const auto recordings = in_two_places();
  test::Several all = test::several(recordings);
  const RecordingNumbers number(all.plate);
  constexpr double kLate = 4e-4;  // [s]
  for (std::size_t i = 0; i < all.beams.size(); ++i) {
    if (number.of(all.beams.time[i]) == 1 && all.beams.laser[i] == 2) all.beams.time[i] -= kLate;
  }
  const SensorModel truth(recordings[0].truth);
  const RecordingLags lags = lags_of_recordings(truth, all.sample(), {});
  ASSERT_EQ(lags.beyond.rows(), 2);
  ASSERT_EQ(lags.beyond.cols(), 3);
  for (Eigen::Index laser = 0; laser < 3; ++laser) {
    const double error = std::hypot(lags.std_errors(0, laser), lags.std_errors(1, laser));
    EXPECT_LT(error, 1e-4);
    const double difference = lags.beyond(1, laser) - lags.beyond(0, laser);
    EXPECT_NEAR(difference, laser == 2 ? kLate : 0, 4 * error) << laser;
  }
  const Sample common = with_common_lags(all.sample(), lags);
  const RecordingLags left = lags_of_recordings(truth, common, {});
  for (Eigen::Index k = 0; k < left.beyond.size(); ++k) {
    EXPECT_LT(std::abs(left.beyond(k)), 0.2 * lags.std_errors(k)) << "nothing is left to be taken away";
  }
}

}  // namespace
}  // namespace crisp
