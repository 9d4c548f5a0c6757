// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>

#include "plugins/diagnose/scans/passes_stage.hpp"
#include "plugins/diagnose/scans/stationary_stage.hpp"
#include "plugins/diagnose/scans/sweep_stage.hpp"
#include "tests/plugins/diagnose/scans/tilting_scene.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

constexpr double kScanPeriod = test::TiltingScene::kPeriod;

template <class S>
test::StageDriver driver(const std::map<std::string, OptionValue>& options = {}) {
  auto made = test::StageDriver::of<S>(options);
  made.run().rig.lasers.resize(1);
  made.run().rig.plate.counts_per_revolution = 360000;
  return made;
}

/// A sweep of 60°/s, then a stationary phase. Every other scan is shifted by half a beam, and scans may
/// arrive in pairs.
void feed_sweep_and_rest(test::StageDriver& stage, double shift, bool two_by_two) {
  test::TiltingScene scene(0.005);
  for (std::uint16_t i = 0; i < 250; ++i) {
    const double taken = kScanPeriod * i;
    const double tilt = 20 * kDegree + 60 * kDegree * std::min(taken, 1.2);
    const bool other = i % 2 == 1;
    const double receipt = two_by_two && !other ? taken + kScanPeriod - 0.001 : taken;
    const double read = 20 * kDegree + 60 * kDegree * std::min(receipt, 1.2);
    stage.feed(test::reading_at(read, receipt));
    stage.feed(std::shared_ptr<const Scan>(
        scene.scan(tilt, (20 + (other ? shift : 0)) * kDegree, other ? 140 : 141, i, receipt)));
  }
}

TEST(DiagnoseStationary, NamesAnInterleaveAndCorrectsTheAngles) {
  const test::TemporaryFolder folder;
  auto stage = driver<DiagnoseStationaryStage>({{"folder", folder.path().string()}});
  feed_sweep_and_rest(stage, 0.5, false);
  stage.finish();
  const auto findings = stage.given<Findings>();
  ASSERT_THAT(findings, SizeIs(1));
  ASSERT_THAT(findings[0]->findings, SizeIs(1));
  const Finding& found = findings[0]->findings[0];
  EXPECT_EQ(found.cause, "mirror.interleave");
  EXPECT_NEAR(found.parameters[0].value, 0.5 * kDegree, 3 * found.parameters[0].std_error + 0.005 * kDegree);
  EXPECT_LT(findings[0]->before_p, 0.001);
  EXPECT_GT(findings[0]->after_p, 0.01);
  ASSERT_THAT(findings[0]->departures, SizeIs(1));
  EXPECT_EQ(findings[0]->departures[0].covariate, "count of scans");
  EXPECT_EQ(findings[0]->departures[0].p_value_after, findings[0]->after_p);
  ASSERT_THAT(found.gain, SizeIs(2)) << "stationary, and in the sweep";
  EXPECT_LT(found.gain[1].ci95[1], 0);
  const auto scans = stage.given<Scan>();
  ASSERT_THAT(scans, SizeIs(250));
  EXPECT_DOUBLE_EQ(scans[0]->start_angle, 20 * kDegree);
  EXPECT_NEAR(scans[1]->start_angle, 20.5 * kDegree, 0.05 * kDegree);
  EXPECT_THAT(stage.given<PlateReading>(), SizeIs(250));
  EXPECT_THAT(stage.report().written, ElementsAre(folder.path() / "laser1_rest.svg"));
}

TEST(DiagnoseStationary, KeepsIdenticalScans) {
  auto stage = driver<DiagnoseStationaryStage>();
  feed_sweep_and_rest(stage, 0, false);
  stage.finish();
  EXPECT_THAT(stage.given<Findings>().at(0)->findings, IsEmpty());
  EXPECT_THAT(stage.given<Findings>().at(0)->unnamed, IsEmpty());
  EXPECT_THAT(stage.given<Findings>().at(0)->departures, IsEmpty());
  EXPECT_GT(stage.given<Findings>().at(0)->before_p, 0.01);
  EXPECT_EQ(stage.given<Findings>().at(0)->after_p, stage.given<Findings>().at(0)->before_p);
  for (const auto& scan : stage.given<Scan>()) EXPECT_DOUBLE_EQ(scan->start_angle, 20 * kDegree);
}

ClockMap even_clock() {
  return {.device = "laser1",
          .pieces = ClockPieces({.device_begin = 0, .hub_begin = 17, .rate = 1}),
          .stamps = 2};
}

TEST(DiagnoseSweep, NamesBurstsAndReportsACommonLagAsUnobservable) {
  auto stage = driver<DiagnoseSweepStage>();
  feed_sweep_and_rest(stage, 0, true);
  stage.feed(even_clock());
  stage.finish();
  const auto& findings = *stage.given<Findings>().at(0);
  ASSERT_THAT(findings.findings, SizeIs(1));
  EXPECT_EQ(findings.findings[0].cause, "latency.bursts");
  EXPECT_TRUE(findings.findings[0].accepted);
  EXPECT_GT(findings.findings[0].gain.at(0).before, 2 * findings.findings[0].gain.at(0).after);
  EXPECT_LT(findings.before_p, 0.01);
  EXPECT_GT(findings.after_p, 0.01);
  EXPECT_THAT(findings.unobservable, ElementsAre(Field(&Unobservable::parameter, "laser1.eta"),
                                                 Field(&Unobservable::parameter, "laser1.tau"),
                                                 Field(&Unobservable::parameter, "laser1.alpha"),
                                                 Field(&Unobservable::parameter, "laser1.range.step")));
}

TEST(DiagnoseSweep, NamesBurstsWithoutASweep) {
  auto stage = driver<DiagnoseSweepStage>();
  test::TiltingScene scene(0.005);
  for (std::uint16_t i = 0; i < 100; ++i) {
    const double receipt = kScanPeriod * (i + 1 - i % 2) - (i % 2 == 0 ? 0.001 : 0);
    stage.feed(test::reading_at(60 * kDegree, receipt));
    stage.feed(std::shared_ptr<const Scan>(scene.scan(60 * kDegree, 20 * kDegree, 140, i, receipt)));
  }
  stage.feed(even_clock());
  stage.finish();
  const auto& findings = *stage.given<Findings>().at(0);
  ASSERT_THAT(findings.findings, SizeIs(1));
  EXPECT_EQ(findings.findings[0].cause, "latency.bursts");
  EXPECT_FALSE(findings.findings[0].accepted) << "no sweep shows a gain by stamps";
  EXPECT_EQ(findings.findings[0].rejection_reason(),
            "without a sweep, the gain of its stamps over receipt times is unknown");
  EXPECT_THAT(findings.findings[0].gain, IsEmpty());
  EXPECT_THAT(findings.unobservable, ElementsAre(Field(&Unobservable::parameter, "laser1.eta"),
                                                 Field(&Unobservable::parameter, "laser1.tau"),
                                                 Field(&Unobservable::parameter, "laser1.alpha")));
}

TEST(DiagnoseSweep, FindsNothingInEvenlyReceivedScans) {
  auto stage = driver<DiagnoseSweepStage>();
  feed_sweep_and_rest(stage, 0, false);
  stage.feed(even_clock());
  stage.finish();
  EXPECT_THAT(stage.given<Findings>().at(0)->findings, IsEmpty());
  EXPECT_GT(stage.given<Findings>().at(0)->before_p, 0.01);
}

TEST(DiagnosePasses, NeedsPassesInBothDirections) {
  auto stage = driver<DiagnosePassesStage>();
  feed_sweep_and_rest(stage, 0, false);
  stage.feed(PlateTrajectory(0, {0, 1}, {0, 1}, 2));
  stage.finish();
  EXPECT_THAT(stage.given<Findings>().at(0)->unobservable,
              ElementsAre(Field(&Unobservable::reason, HasSubstr("in one direction only"))));
  EXPECT_TRUE(std::isnan(stage.given<Findings>().at(0)->before_p)) << "no passes were compared";
  EXPECT_THAT(stage.given<PlateTrajectory>(), SizeIs(1));
}

/// A plane across the actuator's axis: all angles have the same ranges, so a shift is unobservable.
TEST(DiagnosePasses, ReportsAnUnobservableShiftWithoutNumbers) {
  const test::TemporaryFolder folder;
  auto stage = driver<DiagnosePassesStage>({{"folder", folder.path().string()}});
  for (std::uint16_t i = 0; i < 200; ++i) {
    const double angle = 0.01 * (i < 100 ? i : 200 - i);
    auto scan = std::make_shared<Scan>();
    scan->scan_counter = i;
    scan->receipt_ns = static_cast<std::int64_t>(1e9 * kScanPeriod * i);
    scan->echoes.push_back({.ranges = std::vector<float>(30, 2.0F), .remissions = {}});
    stage.feed(test::reading_at(angle, kScanPeriod * i));
    stage.feed(std::shared_ptr<const Scan>(scan));
  }
  stage.feed(PlateTrajectory(0, {0, 1, 2}, {0, 1, 0}, 10));
  stage.finish();
  const auto& findings = *stage.given<Findings>().at(0);
  EXPECT_THAT(findings.findings, IsEmpty());
  EXPECT_THAT(findings.unobservable, ElementsAre(Field(&Unobservable::reason, HasSubstr("has no minimum"))));
  for (const auto& line : stage.report().lines) EXPECT_THAT(line, testing::Not(HasSubstr("nan")));
}

TEST(DiagnosePasses, ReportsAStationaryActuator) {
  test::TiltingScene scene(0.005);
  auto stage = driver<DiagnosePassesStage>();
  for (std::uint16_t i = 0; i < 60; ++i) {
    stage.feed(test::reading_at(0.5, kScanPeriod * i));
    stage.feed(std::shared_ptr<const Scan>(scene.scan(0.5, 20 * kDegree, 141, i, kScanPeriod * i)));
  }
  stage.feed(PlateTrajectory(0, {0, 1}, {0.5, 0.5}, 10));
  stage.finish();
  EXPECT_THAT(stage.given<Findings>()[0]->unobservable,
              ElementsAre(Field(&Unobservable::reason, HasSubstr("has no pass of at least"))));
}

constexpr double kActuatorStep = 0.1 * kDegree;  // of the actuator

/// Feeds 500 steps up and 500 down, and ends.
///
/// @param behind  steps by which the actuator lags its reading on the downward pass, at a number of steps
/// @return the readings, scan by scan
std::vector<double> feed_up_and_down(test::StageDriver& stage, const std::function<double(int at)>& behind) {
  test::TiltingScene scene(0.01);
  std::vector<double> times, angles;
  for (int i = 0; i < 1000; ++i) {
    const bool up = i <= 500;
    const int at = up ? i : 1000 - i;
    const double read = 30 * kDegree + at * kActuatorStep;
    times.push_back(0.1 * i);
    angles.push_back(read);
    stage.feed(test::reading_at(read, times.back()));
    stage.feed(
        std::shared_ptr<const Scan>(scene.scan(read - (up ? 0 : behind(at) * kActuatorStep), 20 * kDegree,
                                               140, static_cast<std::uint16_t>(i), times.back())));
  }
  stage.feed(PlateTrajectory(0, times, angles, 1));
  stage.finish();
  return angles;
}

TEST(DiagnosePasses, NamesBacklashWithItsLagAndRemovesHalfPerDirection) {
  const test::TemporaryFolder folder;
  auto stage = driver<DiagnosePassesStage>({{"folder", folder.path().string()}});
  const std::vector<double> angles = feed_up_and_down(stage, [](int) { return 2; });
  const auto& findings = *stage.given<Findings>().at(0);
  ASSERT_THAT(findings.findings, SizeIs(1)) << stage.report().lines.at(0);
  const Finding& found = findings.findings[0];
  EXPECT_EQ(found.cause, "encoder.backlash");
  EXPECT_THAT(found.confounded_with, ElementsAre("laser1.eta"));
  EXPECT_NEAR(found.parameters[0].value, kActuatorStep,
              3 * found.parameters[0].std_error + 0.02 * kActuatorStep);
  EXPECT_GT(found.log10_bayes_factor, 6) << "against no shift";
  EXPECT_LT(found.p_value, 1e-6);
  EXPECT_LT(findings.before_p, 1e-6);
  EXPECT_GT(findings.after_p, 0.01);
  const auto corrected = stage.given<PlateTrajectory>().at(0);
  EXPECT_NEAR(corrected->angles()[200] - angles[200], kActuatorStep, 0.2 * kActuatorStep);
  EXPECT_NEAR(corrected->angles()[700] - angles[700], -kActuatorStep, 0.2 * kActuatorStep);
  std::ifstream file(folder / "laser1_passes.svg");
  const std::string picture(std::istreambuf_iterator<char>(file), {});
  const std::string shift = fmt::format("estimate: {:+.3f} ± ", -2 * found.parameters[0].value / kDegree);
  EXPECT_THAT(picture, testing::HasSubstr(shift)) << "is marked in the plot";
}

TEST(DiagnosePasses, ReportsThePValueOfAnInhomogeneousShift) {
  auto stage = driver<DiagnosePassesStage>();
  feed_up_and_down(stage, [](int at) { return 3.0 * at / 500; });
  const auto& findings = *stage.given<Findings>().at(0);
  ASSERT_THAT(findings.unnamed, SizeIs(1)) << stage.report().lines.at(0);
  EXPECT_EQ(findings.unnamed[0].p_value, stage.report().section["laser1"]["constant_p"]);
  EXPECT_THAT(stage.report().lines.at(0),
              HasSubstr(fmt::format("homogeneity p = {:.3g}", findings.unnamed[0].p_value)));
}

}  // namespace
}  // namespace crisp
