// SPDX-License-Identifier: BSD-3-Clause
// Recordings of other actuated lasers, as configs/real/ reads them. Where they are not at hand, the tests are
// skipped.
#include "tests/end_to_end/real_data.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include <crisp/calibration_file.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/files/findings_file.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::data;
using namespace crisp::files;

using RealData = test::OnRealData;

std::vector<std::string> unobservable_in(const nlohmann::json& diagnosis) {
  std::vector<std::string> names;
  for (const auto& each : diagnosis["unobservable"]) names.push_back(each["cause"]);
  return names;
}

double p_value_before(const nlohmann::json& diagnosis) { return diagnosis["goodness_of_fit"]["before_p"]; }
double reported_after(const nlohmann::json& diagnosis) { return diagnosis["goodness_of_fit"]["after_p"]; }

nlohmann::json departure_over(const nlohmann::json& diagnosis, const std::string& covariate) {
  for (const auto& each : diagnosis["departures"]) {
    if (each["covariate"] == covariate) return each;
  }
  return {};
}

TEST_F(RealData, OverbotsBeamsAreInterleavedAndItsScansComeInBursts) {
  if (!run("overbot.yaml", "actuated/overbot_sick_lms_tilt/lidarscans20041211_194820.csv")) return;
  EXPECT_EQ(outcome_.stage("table")["report"]["rows"], 300);
  EXPECT_EQ(outcome_.losses("table"), 0U);
  ASSERT_NE(outcome_.cloud, nullptr);
  EXPECT_GT(outcome_.cloud->size(), 40'000U);

  const auto interleave = finding("mirror.interleave");
  ASSERT_TRUE(interleave.is_object());
  const double shift = interleave["parameters"][0]["value"];
  const double error = interleave["parameters"][0]["std_error"];
  EXPECT_NEAR(shift, 0.5 * kDegree, 3 * error + 0.005 * kDegree) << "the LMS takes every other degree's half";
  EXPECT_LT(interleave["gain"][0]["ci95"][1], 0) << "stationary";
  EXPECT_LT(interleave["gain"][1]["ci95"][1], 0) << "in the sweep";

  const auto bursts = finding("latency.bursts");
  ASSERT_TRUE(bursts.is_object());
  EXPECT_LT(bursts["p_value"], 0.01);
  EXPECT_LT(bursts["gain"][0]["ci95"][1], 0);
  EXPECT_LT(bursts["gain"][0]["after"], 0.02) << "by an independent evaluation: 1.5 cm instead of 6.1 cm";
  EXPECT_THAT(unobservable_in(diagnosis_),
              testing::ElementsAre("lms.eta", "lms.tau", "lms.alpha", "lms.range.step"));

  EXPECT_LT(p_value_before(diagnosis_), 0.01);
  const auto timed = departure_over(diagnosis_, "receipt less stamp");
  EXPECT_LT(timed["p_value"], 0.01);
  EXPECT_GT(timed["p_value_after"], 0.05) << "by their stamps scans are where their neighbours predict them";
  const auto taken_in_turn = departure_over(diagnosis_, "count of scans");
  EXPECT_LT(taken_in_turn["amplitude_after"], 0.3 * taken_in_turn["amplitude"].get<double>());
  EXPECT_LT(taken_in_turn["p_value_after"], 0.01) << "scans of one class differ, too";
}

TEST_F(RealData, OverbotsOtherRecordingHasTheSameInterleave) {
  if (!run("overbot.yaml", "actuated/overbot_sick_lms_tilt/lidarscans20041210_172937.csv")) return;
  const auto interleave = finding("mirror.interleave");
  ASSERT_TRUE(interleave.is_object());
  const double error = interleave["parameters"][0]["std_error"];
  EXPECT_NEAR(interleave["parameters"][0]["value"].get<double>(), 0.5 * kDegree, 3 * error + 0.005 * kDegree);
  EXPECT_LT(reported_after(diagnosis_), 0.01) << "as those of the first recording";
  EXPECT_TRUE(finding("latency.bursts").is_object()) << "without a sweep as well";
  EXPECT_EQ(outcome_.count("clock.convex_hull", "tilt: telegrams lost"), 0U);
}

TEST_F(RealData, UrgsWaysUpAndDownDifferByAboutAStepAndWhatIsInjectedComesBack) {
  if (!run("urg.yaml", "actuated/urg04lx_tilt_stand/Jeremy.csv")) return;
  const auto& report = outcome_.stage("diagnose.passes")["report"]["urg"];
  EXPECT_NEAR(report["steps"], 1, 0.2) << "of the order of one step, by an independent evaluation";
  EXPECT_NEAR(report["answer_ratio"], 1, 0.1);
  for (const auto& each : report["answers"]) {
    EXPECT_NEAR(each[1], each[0].get<double>(), 0.002 * kDegree) << "also of half a step";
  }
  const auto play = finding("encoder.backlash");
  ASSERT_TRUE(play.is_object());
  EXPECT_THAT(play["confounded_with"], testing::ElementsAre("urg.eta"));
  EXPECT_LT(play["gain"][0]["ci95"][1], 0);
  EXPECT_LT(p_value_before(diagnosis_), 1e-20);
  EXPECT_GT(reported_after(diagnosis_), 0.01);
}

TEST_F(RealData, UrgsShiftOverNinetyDegreesIsNotTheSameEverywhereAndHasNoName) {
  if (!run("urg.yaml", "actuated/urg04lx_tilt_stand/0_to_pos90_degree.csv", {"first=0deg"})) return;
  const auto& report = outcome_.stage("diagnose.passes")["report"]["urg"];
  EXPECT_NEAR(report["answer_ratio"], 1, 0.1);
  EXPECT_THAT(diagnosis_["findings"], testing::IsEmpty());
  ASSERT_THAT(diagnosis_["unnamed"], testing::SizeIs(1));
  EXPECT_EQ(diagnosis_["unnamed"][0]["quantity"], "plate angle");
  EXPECT_EQ(diagnosis_["unnamed"][0]["p_value"], report["constant_p"]);
  EXPECT_LT(p_value_before(diagnosis_), 1e-10);
  EXPECT_LT(reported_after(diagnosis_), 1e-3) << "what is not the same everywhere stays";
}

TEST_F(RealData, UrgsShortWayBackDoesNotDetermineTheShift) {
  if (!run("urg.yaml", "actuated/urg04lx_tilt_stand/room_240.csv", {"first=-2.086213827rad"})) return;
  EXPECT_THAT(diagnosis_["findings"], testing::IsEmpty());
  EXPECT_THAT(diagnosis_["unnamed"], testing::IsEmpty());
  EXPECT_TRUE(diagnosis_["goodness_of_fit"]["before_p"].is_null()) << "nothing was compared";
}

TEST_F(RealData, HrlsSingleSweepDeterminesNeitherItsAnglesNorItsMounting) {
  if (!run("hrl.yaml", "actuated/hrl_utm30lx_tilt/ROStest_laserscans.csv")) return;
  EXPECT_THAT(diagnosis_["findings"], testing::IsEmpty());
  EXPECT_THAT(diagnosis_["unnamed"], testing::IsEmpty());
  EXPECT_THAT(unobservable_in(diagnosis_),
              testing::ElementsAre("encoder.backlash", "utm.eta", "utm.tau", "utm.alpha", "utm.range.step",
                                   "utm.tau", "utm.mount.tangential_offset"));
  EXPECT_THAT(std::string(diagnosis_["unobservable"][5]["reason"]),
              testing::AllOf(testing::StartsWith("its standard error of "),
                             testing::Not(testing::HasSubstr("windows"))));
  EXPECT_GT(p_value_before(diagnosis_), 0.01) << "ranges are predicted as well as in a simulated sweep";
  const auto& answers = outcome_.stage("sweep")["report"]["utm_answers"];
  EXPECT_GT(answers["by_turns"].front(), 1.5 * answers["by_turns"][5].get<double>())
      << "scans that were shifted by turns are detected";
  EXPECT_LT(answers["common"].front(), 1.5 * answers["by_turns"][5].get<double>())
      << "but not all of them alike";
  ASSERT_NE(outcome_.cloud, nullptr);
  EXPECT_EQ(outcome_.cloud->size(), 56073U);
}

constexpr const char* kVelodyne = "actuated/velodyne_vlp16_static/sample_velodyne_vlp16_gps.pcap";

/// The VLP-16's azimuths, with those of every other laser turned by hand before the calibration.
struct TurnedHead {
  TurnedHead(const test::PipelineFixture& fixture, const std::filesystem::path& capture, double by) {
    Calibration start = read_calibration(source_dir() + "/configs/real/vlp16_start.yaml");
    for (std::size_t i = 1; i < start.lasers.size(); i += 2) start.lasers[i].lambda.value += by;
    write_calibration(fixture / "start.yaml", start);
    outcome = fixture.run("real/vlp16.yaml", capture, "out", {"start=" + (fixture / "start.yaml").string()});
    const auto found = read_calibration(fixture / "out/calibration.yaml");
    double even = 0, odd = 0;
    for (std::size_t i = 3; i < found.lasers.size(); ++i) {
      (i % 2 == 1 ? even : odd) += found.lasers[i].lambda.value / (i % 2 == 1 ? 7 : 6);
    }
    apart = even - odd;
  }
  test::Outcome outcome;
  double apart = 0;  ///< [rad] mean azimuth of the even lasers less that of the odd ones
};

TEST_F(RealData, VelodynesLasersComeBackToOneAnotherFromAnAngleThatIsInjectedByHand) {
  if (!at_hand(kVelodyne)) return;
  const auto capture = shared_data() / kVelodyne;
  const TurnedHead as_made(fixture_, capture, 0);
  EXPECT_EQ(as_made.outcome.status, ExitStatus::done) << as_made.outcome.console;
  EXPECT_NEAR(as_made.apart, 0, 0.2 * kDegree) << "as the maker has them";
  for (const double degrees : {-1.0, 1.0, 3.0}) {
    const TurnedHead turned(fixture_, capture, degrees * kDegree);
    EXPECT_NEAR(turned.apart - as_made.apart, 0, 0.1 * std::abs(degrees) * kDegree + 0.05 * kDegree)
        << degrees;
  }
}

TEST_F(RealData, VelodynesStandardErrorsCoverItsDataSheet) {
  if (!at_hand(kVelodyne)) return;
  ASSERT_EQ(fixture_.run("real/vlp16.yaml", shared_data() / kVelodyne, "out").status, ExitStatus::done);
  const auto found = read_calibration(fixture_ / "out/calibration.yaml");
  for (const auto& laser : found.lasers) {
    if (!laser.lambda.free) continue;
    EXPECT_LT(std::abs(laser.lambda.value), 4 * laser.lambda.std_error)
        << laser.name << ": relative to beam02, whose own error all of them share";
  }
}

TEST_F(RealData, VelodynesNoiseGrowsWithTheIncidenceAndComesInStepsOfTwoMillimetres) {
  if (!run("vlp16.yaml", kVelodyne)) return;
  const Findings found = read_findings(fixture_ / "out/diagnosis.json");
  int grow = 0;
  int in_steps = 0;
  for (const Finding& one : found.findings) {
    if (!one.accepted) continue;
    const double value = one.parameters.at(0).value;
    if (one.cause == "noise.quantisation") in_steps += std::abs(value - 0.002) < 1e-6 ? 1 : 0;
    if (one.cause != "noise.incidence_dependent") continue;
    ++grow;
    EXPECT_GT(value, 0.003) << one.scope << ": 3.1 to 4.5 mm by an independent evaluation of all of them";
    EXPECT_LT(value, 0.010) << one.scope << ": few surfaces, none of them a plane";
  }
  EXPECT_EQ(in_steps, 14) << "as its packets have them";
  EXPECT_GE(grow, 2) << "of nine that meet enough surface";
}

TEST_F(RealData, ASecondLms1xxHasTwoPeaksAsWell) {
  if (!run("lms1xx.yaml", "actuated/sick_lms1xx_static/lms1xx_scans.csv")) return;
  const auto peaks = finding("noise.two_peaks");
  ASSERT_TRUE(peaks.is_object());
  EXPECT_GT(peaks["parameters"][0]["value"], 0.0135) << "independent evaluation: 13.5 to 16.7 mm";
  EXPECT_LT(peaks["parameters"][0]["value"], 0.0167);
  EXPECT_GT(peaks["gain"][0]["ci95"][0], 0);
  const auto slow = finding("mirror.period");
  ASSERT_TRUE(slow.is_object());
  const double excess = slow["parameters"][0]["value"];
  EXPECT_NEAR(1 / (0.02 + excess), 49.89, 0.05) << "Hz, by an independent evaluation";
}

TEST_F(RealData, ThreeStreamsOfOneClockOverWiFiGiveOneRate) {
  double weights = 0, mean = 0, squares = 0;
  for (const std::string stream : {"scan", "imu", "ultrasonic"}) {
    if (!run("clocks.yaml", "clocks/esp32_wifi_A_" + stream + ".csv")) return;
    EXPECT_THAT(diagnosis_["findings"], testing::IsEmpty()) << stream;
    const auto& device = diagnosis_["devices"].at(0);
    const double skew = device["skew"], error = device["skew_std_error"];
    weights += 1 / (error * error);
    mean += skew / (error * error);
    squares += skew * skew / (error * error);
    EXPECT_GT(device["delay_median"], 0.01) << stream;
  }
  EXPECT_LT(squares - mean * mean / weights, 9.2) << "of chi2 with two degrees of freedom one in a hundred";
  EXPECT_NEAR(mean / weights, -110e-6, 60e-6) << "independent evaluation: 88 to 117 ppm slow";
}

TEST_F(RealData, TheTimesOfATiM781AreOfSendingAndOfScanning) {
  // device µs of transmission and host ns of the first packet: 4.1 ppm by an independent evaluation, delays
  // of 72 and 271 µs
  if (!run("clocks.yaml", "clocks/sick_tim781_tcp.csv",
           {"grabber.table.time_column=4", "grabber.table.time_unit=us", "grabber.table.receipt_column=5"})) {
    return;
  }
  EXPECT_THAT(diagnosis_["findings"], testing::IsEmpty());
  const auto sending = diagnosis_["devices"].at(0);
  EXPECT_NEAR(double{sending["skew"]}, 4.1e-6, 3 * double{sending["skew_std_error"]});
  EXPECT_LT(double{sending["skew_std_error"]}, 0.5e-6);
  EXPECT_NEAR(double{sending["delay_median"]}, 72e-6, 5e-6);
  EXPECT_NEAR(double{sending["delay_95"]}, 271e-6, 10e-6);
  // of the scan's start: the mirror's place at sending is among the delays
  run("clocks.yaml", "clocks/sick_tim781_tcp.csv",
      {"grabber.table.time_column=3", "grabber.table.time_unit=us", "grabber.table.receipt_column=6"});
  const auto scanning = diagnosis_["devices"].at(0);
  EXPECT_NEAR(double{scanning["skew"]}, 3.6e-6, 3 * double{scanning["skew_std_error"]});
  EXPECT_GT(double{scanning["skew_std_error"]}, 3 * double{sending["skew_std_error"]});
}

TEST_F(RealData, ALaserThatStartsLateIsReportedWithinItsRecording) {
  // 45 scans come up to 0.4 s late at first, and catch up: no step.
  if (!run("clocks.yaml", "clocks/overbot_lms_20041211.csv",
           {"grabber.table.time_column=auto", "grabber.table.counter_column=1",
            "grabber.table.period=13.3333ms"})) {
    return;
  }
  EXPECT_THAT(diagnosis_["findings"], testing::IsEmpty());
  EXPECT_TRUE(diagnosis_["devices"][0]["period"].is_null())
      << "its times are its count times the nominal period";
  ASSERT_EQ(diagnosis_["unnamed"].size(), 1U);
  const auto& backlog = diagnosis_["unnamed"][0];
  EXPECT_EQ(backlog["covariate"], "time");
  EXPECT_EQ(backlog["quantity"], "delay");
  EXPECT_EQ(backlog["unit"], "s");
  EXPECT_GT(backlog["amplitude"], 0.02);
  EXPECT_LT(backlog["amplitude"], 0.2) << "0.4 s at most, for 0.6 of 3.9 s";
}

}  // namespace
}  // namespace crisp
