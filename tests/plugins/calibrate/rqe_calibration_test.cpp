// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rqe_calibration.hpp"

#include <gmock/gmock.h>

#include <crisp/error.hpp>

#include "grabbers/simulate/shapes.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using namespace crisp::data;
using namespace crisp::estimate;
using namespace crisp::simulate;

RqeCalibrationSettings quick() { return {.points = 30000, .probes = 4}; }

TEST(CalibrateByRqe, FindsAScannerThatIsOffByCentimetresDegreesAndMilliseconds) {
  const auto recording = simulate_measurements(misplaced_scanner(2, 5.0), office());
  SensorModel start(nominal_calibration(default_rig()));
  const auto measure = rqe_measure();
  std::vector<double> reported;
  const Outcome outcome = calibrate_by_rqe(start, sample_of(recording), *measure, quick(),
                                           [&](double done, std::string_view) { reported.push_back(done); });
  const Eigen::VectorXd error = outcome.model.values() - SensorModel(recording.truth).values();
  for (std::size_t laser = 0; laser < 3; ++laser) {
    // The bias of the optimum at σ = 5 cm, as far as it goes in the office.
    const auto first = static_cast<Eigen::Index>(4 * laser);
    EXPECT_LT(std::abs(std::remainder(error[first], 2 * std::numbers::pi)), 0.6 * kDegree);
    EXPECT_LT(std::abs(error[first + 1]), 0.010);
    EXPECT_LT(std::abs(error[first + 2]), 0.6 * kDegree);
    EXPECT_LT(std::abs(error[first + 3]), 0.0006);
  }
  EXPECT_EQ(outcome.free.size(), 11U);
  EXPECT_TRUE(outcome.unobservable.empty());
  EXPECT_THAT(outcome.caveats, testing::IsEmpty());
  EXPECT_GT(outcome.covariance.diagonal().minCoeff(), 0);
  EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
  EXPECT_GT(reported.size(), 3U);
}

TEST(CalibrateByRqe, ReportsThatAConstantSpeedDoesNotDetermineTheLags) {
  auto scanner = misplaced_scanner(1, 3.0);
  scanner.motion = {.kind = MotionKind::constant, .max_rate = 0.91};  // no whole number of scans a turn
  for (auto& laser : scanner.truth.lasers) laser.eta.value = 0;
  const auto recording = simulate_measurements(scanner, office());
  SensorModel start(nominal_calibration(default_rig()));
  const auto measure = rqe_measure();
  const Outcome outcome = calibrate_by_rqe(start, sample_of(recording), *measure, quick());
  ASSERT_EQ(outcome.unobservable.size(), 3U);
  for (const auto& lost : outcome.unobservable) EXPECT_THAT(lost.parameter, testing::EndsWith(".eta"));
  // 0.91 Hz are 5.718 rad/s.
  EXPECT_EQ(outcome.unobservable[0].combination,
            "laser2.lambda - 5.718 * laser1.eta, laser3.lambda - 5.718 * laser1.eta");
  EXPECT_EQ(outcome.unobservable[1].combination, "laser2.lambda + 5.718 * laser2.eta");
  EXPECT_EQ(outcome.unobservable[2].combination, "laser3.lambda + 5.718 * laser3.eta");
  EXPECT_EQ(outcome.free.size(), 8U);
  const Eigen::VectorXd error = outcome.model.values() - SensorModel(recording.truth).values();
  for (const auto lambda : {4, 8}) {
    EXPECT_LT(std::abs(std::remainder(error[lambda], 2 * std::numbers::pi)), 1.0 * kDegree);
  }
}

TEST(CalibrateByRqe, FindsALagAgainstAKnownAzimuthAtConstantSpeed) {
  // A laser's own beams do not show its lag then, and any value in its range is as good: the azimuth is
  // known.
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    auto scanner = misplaced_scanner(seed, 3.0);
    scanner.motion = {.kind = MotionKind::constant, .max_rate = 1.4985};
    const auto recording = simulate_measurements(scanner, office());
    const Calibration truth = SensorModel(recording.truth).calibration();
    SensorModel start(nominal_calibration(default_rig()));
    RqeCalibrationSettings settings = quick();
    settings.in_plane.range.eta = 0.1;
    for (const LaserCalibration& laser : truth.lasers) {
      settings.in_plane.range.nominal[laser.name + ".lambda"] = {.value = laser.lambda.value,
                                                                 .std_error = 0.2 * kDegree};
      start = with_one(start, start.index(laser.name + ".lambda"), laser.lambda.value);
    }
    const auto measure = rqe_measure();
    const Outcome outcome = calibrate_by_rqe(start, sample_of(recording), *measure, settings);
    for (std::size_t k = 1; k < truth.lasers.size(); ++k) {
      const auto eta = static_cast<Eigen::Index>(outcome.model.index(truth.lasers[k].name + ".eta"));
      const double against_first = truth.lasers[k].eta.value - truth.lasers[0].eta.value;
      EXPECT_NEAR(outcome.model.values()[eta], against_first, 4e-3) << seed << ": RQE is off by a degree";
    }
  }
}

TEST(CalibrateByRqe, HoldsLagsThatReachTheEndOfTheirRange) {
  auto scanner = misplaced_scanner(1, 3.0);
  for (auto& laser : scanner.truth.lasers) laser.eta.value = 0.03;
  const auto recording = simulate_measurements(scanner, office());
  const SensorModel start(nominal_calibration(default_rig()));
  RqeCalibrationSettings settings = quick();
  settings.in_plane.range.eta = 0.01;
  const auto measure = rqe_measure();
  const Outcome outcome = calibrate_by_rqe(start, sample_of(recording), *measure, settings);
  ASSERT_EQ(outcome.not_estimated.size(), 3U);
  for (const std::size_t held : outcome.not_estimated) {
    EXPECT_THAT(start.names()[held], testing::EndsWith(".eta"));
    EXPECT_EQ(outcome.model.values()[static_cast<Eigen::Index>(held)], 0);
    EXPECT_THAT(outcome.free, testing::Not(testing::Contains(held)));
  }
  EXPECT_GE(outcome.free.size(), 6U) << "the others are found with the lags held";
  EXPECT_EQ(outcome.covariance.rows(), static_cast<Eigen::Index>(outcome.free.size()));
}

TEST(CalibrateByRqe, LeavesWhatItDoesNotDetermineAtItsStart) {
  const auto recording = simulate_measurements(misplaced_scanner(1, 3.0), office());
  const SensorModel start(nominal_calibration(default_rig()));
  RqeCalibrationSettings settings = quick();
  settings.full_field = false;
  settings.in_plane.range.tau = 1e-5;  // known better than any optimum of two beams
  const auto measure = rqe_measure();
  const Outcome outcome = calibrate_by_rqe(start, sample_of(recording), *measure, settings);
  ASSERT_EQ(outcome.unobservable.size(), 3U);
  for (const auto& lost : outcome.unobservable) {
    EXPECT_THAT(lost.parameter, testing::EndsWith(".tau"));
    const auto place = static_cast<Eigen::Index>(outcome.model.index(lost.parameter));
    EXPECT_EQ(outcome.model.values()[place], start.values()[place]) << lost.parameter;
  }
}

TEST(CalibrateByRqe, SeesOnlySpotsAtCommensurateRates) {
  auto scanner = misplaced_scanner(1, 3.0);
  scanner.motion = {.kind = MotionKind::constant, .max_rate = 2};  // 25 scans a turn
  scanner.mirror = {.slowest = 0, .wander = 0};
  const auto few = simulate_measurements(scanner, office());
  EXPECT_TRUE(sees_single_spots(sample_of(few), {}));
  scanner.motion.max_rate = 1.91;
  const auto many = simulate_measurements(scanner, office());
  EXPECT_FALSE(sees_single_spots(sample_of(many), {}));
}

TEST(CalibrateByRqe, FindsTheLagsOfAPlateThatTurnsToAndFro) {
  const auto measure = rqe_measure();
  RqeCalibrationSettings settings = quick();
  settings.full_field = false;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {  // kernels alone got three of these wrong
    auto scanner = misplaced_scanner(seed, 10);
    scanner.motion.kind = MotionKind::reversal;
    const auto recording = simulate_measurements(scanner, hall());
    const Outcome outcome = calibrate_by_rqe(SensorModel(nominal_calibration(default_rig())),
                                             sample_of(recording), *measure, settings);
    EXPECT_THAT(outcome.caveats, testing::IsEmpty()) << seed;
    const Eigen::VectorXd error = outcome.model.values() - SensorModel(recording.truth).values();
    for (const auto eta : {3, 7, 11}) EXPECT_LT(std::abs(error[eta]), 1e-3) << seed << ", " << eta;
  }
}

TEST(CalibrateByRqe, FindsWhereALaserSitsThatIsThoughtToBeOnTheSpinAxis) {
  auto scanner = misplaced_scanner(1, 5.0);
  const auto recording = simulate_measurements(scanner, office());
  Calibration nominal = nominal_calibration(default_rig());
  nominal.lasers[1].tau.value = 0;  // where α turns its cloud as λ does
  RqeCalibrationSettings settings = quick();
  settings.full_field = false;
  const auto measure = rqe_measure();
  const Outcome outcome = calibrate_by_rqe(SensorModel(nominal), sample_of(recording), *measure, settings);
  EXPECT_TRUE(outcome.unobservable.empty());
  const Eigen::VectorXd error = outcome.model.values() - SensorModel(recording.truth).values();
  EXPECT_LT(std::abs(error[5]), 0.03) << "τ, with the bias of σ = 10 cm in two beams";
  EXPECT_LT(std::abs(error[6]), 3 * kDegree) << "α";
}

/// By two lasers.
SimulatedMeasurements in_a_room_that_looks_the_same_from_behind() {
  const Scene twin{.name = "twin",
                   .surfaces = walls("wall", {{-4, -3}, {4, -3}, {4, 3}, {-4, 3}}, -1, 1, 0.5)};
  ScannerSettings scanner;
  scanner.rig.lasers.resize(2);
  scanner.truth = nominal_calibration(scanner.rig);
  scanner.duration = 5;
  return simulate_measurements(scanner, twin);
}

TEST(CalibrateByRqe, IsNotSureInARoomThatTestsTheSameFromBehind) {
  const auto recording = in_a_room_that_looks_the_same_from_behind();
  RqeCalibrationSettings settings = quick();
  settings.full_field = false;
  const auto measure = rqe_measure();
  Calibration start = recording.truth;
  start.lasers[1].lambda.value += 70 * kDegree;
  const Outcome outcome = calibrate_by_rqe(SensorModel(start), sample_of(recording), *measure, settings);
  ASSERT_EQ(outcome.other_minima.size(), 1U);
  EXPECT_THAT(outcome.other_minima[0], testing::StartsWith("laser2.lambda has a competing minimum at "));
}

TEST(CalibrateByRqe, TheNominalLambdaSelectsOneOfTwoMinima) {
  const auto recording = in_a_room_that_looks_the_same_from_behind();
  RqeCalibrationSettings settings = quick();
  settings.full_field = false;
  const auto measure = rqe_measure();
  for (const double off : {-10 * kDegree, 10 * kDegree}) {
    Calibration start = recording.truth;
    start.lasers[1].lambda.value += off;
    const Outcome outcome = calibrate_by_rqe(SensorModel(start), sample_of(recording), *measure, settings);
    EXPECT_THAT(outcome.other_minima, testing::IsEmpty());
    const double found = outcome.model.calibration().lasers[1].lambda.value;
    EXPECT_NEAR(std::remainder(found - recording.truth.lasers[1].lambda.value, 2 * std::numbers::pi), 0,
                2 * kDegree);
  }
}

TEST(CalibrateByRqe, RefusesARecordingThatIsTooShortForTheLagsAtOnce) {
  const auto recording = simulate_measurements(misplaced_scanner(2, 0.3), office());
  const auto measure = rqe_measure();
  const SensorModel start(nominal_calibration(default_rig()));
  std::vector<double> reported;
  const auto calibrate = [&] {
    calibrate_by_rqe(start, sample_of(recording), *measure, quick(),
                     [&](double done, std::string_view) { reported.push_back(done); });
  };
  EXPECT_THAT(calibrate, testing::ThrowsMessage<Error>(testing::HasSubstr("the recording is too short")));
  EXPECT_THAT(reported, testing::IsEmpty());
}

TEST(CalibrateByRqe, NeverTestsAtLagsAtWhichBeamsAreNotCovered) {
  const auto recording = simulate_measurements(misplaced_scanner(2, 1.0), office());
  Calibration nominal = nominal_calibration(default_rig());
  for (auto& laser : nominal.lasers) laser.tau.value = 1.5;  // so that no cloud is crisp anywhere near
  const auto measure = rqe_measure();
  try {
    calibrate_by_rqe(SensorModel(nominal), sample_of(recording), *measure, {.points = 3000, .probes = 4});
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("the end of its search range"));
  }
}

TEST(CalibrateByRqe, RefusesAPlateThatStandsStill) {
  auto scanner = misplaced_scanner(1, 1.0);
  const auto recording = simulate_measurements(scanner, office(), Motion({{.time = 0, .rate = 0}}));
  const SensorModel start(nominal_calibration(default_rig()));
  const auto measure = rqe_measure();
  EXPECT_THROW(calibrate_by_rqe(start, sample_of(recording), *measure, quick()), Error);
}

}  // namespace
}  // namespace crisp
