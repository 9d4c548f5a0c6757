// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/predicted_recording.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "pipeline/data/degree.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"
#include "tests/plugins/diagnose/hidden.hpp"
#include "tests/support/other_places.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;
using namespace crisp::quality;
using namespace crisp::simulate;
using namespace crisp::data;
using namespace crisp::statistics;

/// Beams on flat surfaces of a short recording in the office.
struct Recorded {
  test::Recording recording = test::hidden(6, 4, office(), {});
  SensorModel model{recording.made.truth, built_in_terms()};
  SurfaceObservations observations{model, covered(recording.sample(), -0.05, 0.05), {}, 100'000};

  PredictedRecording predicted(std::vector<double> angles, const Standpoint& standpoint = {}) const {
    const Sample pattern = thin_evenly(observations.sample(), 20'000, 1);
    return predicted_recording(model, pattern, observations.beams(), observations.surfels(),
                               std::move(angles), standpoint);
  }
  std::vector<double> angles() const {
    const auto all = recording.made.plate.angles();
    return {all.begin(), all.end()};
  }
};

/// [m] Departures from the ranges that the same beams (by time and number) had.
std::vector<double> range_errors(const PredictedRecording& predicted, const Measurements& truth) {
  std::vector<double> errors;
  std::size_t i = 0;
  for (std::size_t k = 0; k < predicted.beams.size(); ++k) {
    while (i < truth.size() &&
           (truth.time[i] != predicted.beams.time[k] || truth.laser[i] != predicted.beams.laser[k] ||
            truth.beam[i] != predicted.beams.beam[k]))
      ++i;
    if (i == truth.size()) break;
    errors.push_back(std::abs(double{predicted.beams.range[k]} - double{truth.range[i]}));
  }
  return errors;
}

TEST(PredictedRecording, OfTheSameMotionHasTheRecordedRanges) {
  const Recorded recorded;
  const PredictedRecording same = recorded.predicted(recorded.angles());
  EXPECT_GT(same.beams.size(), 15'000U);
  auto errors = range_errors(same, recorded.observations.sample().beams);
  ASSERT_GT(errors.size(), 15'000U);
  EXPECT_LT(quantile_in_place(errors, 0.9), 0.03) << "m; noise is 12 mm";
}

TEST(PredictedRecording, OfAnotherMotionHasTheRangesOfItsSimulation) {
  const Recorded recorded;
  // A quarter of a turn further on all the time: simulated by another nominal azimuth of all lasers.
  std::vector<double> angles = recorded.angles();
  for (double& angle : angles) angle += std::numbers::pi / 2;
  const PredictedRecording turned = recorded.predicted(angles);
  ScannerSettings scanner = recorded.recording.scanner;
  scanner.truth = recorded.recording.made.truth;
  for (auto& laser : scanner.truth.lasers) laser.lambda.value += std::numbers::pi / 2;
  const auto simulated = test::recorded(scanner, office());
  auto errors = range_errors(turned, simulated.made.beams);
  ASSERT_GT(errors.size(), 10'000U);
  EXPECT_LT(quantile_in_place(errors, 0.9), 0.04);
}

TEST(PredictedRecording, OfALargerPlaceHasTheRangesOfItsSimulation) {
  const Recorded recorded;
  const PredictedRecording far = recorded.predicted(recorded.angles(), {.distance = 3});
  ScannerSettings scanner = recorded.recording.scanner;
  scanner.truth = recorded.recording.made.truth;
  const auto simulated =
      test::recorded(scanner, test::seen_from_elsewhere(office(), Eigen::Matrix3d::Identity(), 3));
  auto errors = range_errors(far, simulated.made.beams);
  ASSERT_GT(errors.size(), 10'000U);
  EXPECT_LT(quantile_in_place(errors, 0.9), 0.06) << "m; the walls' distance is known to some mm, times 3";
}

TEST(PredictedRecording, OfATiltedScannerLiesOnTheSameSurfaces) {
  const Recorded recorded;
  const Eigen::Matrix3d attitude =
      Eigen::AngleAxisd(30 * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const PredictedRecording tilted = recorded.predicted(recorded.angles(), {.attitude = attitude});
  EXPECT_GT(tilted.beams.size(), 15'000U);
  const PlacedBeams placed(recorded.model, tilted.sample());
  for (const Surfel& surfel : tilted.surfels.surfels) {
    for (const auto i : tilted.surfels.beams_of(surfel)) {
      const auto& points = placed.view().points;
      const Eigen::Vector3d point(points.x[i], points.y[i], points.z[i]);
      ASSERT_NEAR(surfel.normal.dot(point - surfel.middle), 0, 1e-3);
    }
  }
}

}  // namespace
}  // namespace crisp
