// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/report_stage.hpp"

#include <gmock/gmock.h>

#include <crisp/registrar.hpp>

#include "tests/support/built_in_terms.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::report;
using test::StageDriver;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using Json = nlohmann::ordered_json;

/// Beams of three lasers all around, at 2 m, and a plate that turns once a second.
Measurements beams() {
  Measurements all;
  for (int i = 0; i < 3000; ++i) {
    all.range.push_back(2);
    all.mirror_angle.push_back(static_cast<float>(0.001 * (i - 1500)));
    all.time.push_back(0.01 + 0.0003 * i);
    all.laser.push_back(static_cast<std::uint16_t>(i % 3));
    all.remission.push_back(100);
    all.beam.push_back(static_cast<std::uint16_t>(i % 541));
  }
  return all;
}

PlateTrajectory turning() {
  std::vector<double> times, angles;
  for (int i = 0; i <= 100; ++i) {
    times.push_back(0.01 * i);
    angles.push_back(0.0628 * i);
  }
  return {0, times, angles, 0.1};
}

class WriteReport : public testing::Test {
 protected:
  WriteReport() {
    registrar_.attach(terms_, "term");
    register_built_in(terms_);
    driver_.run().registrar = &registrar_;
  }

  Json data_of_page() const {
    const std::string page = test::bytes_of(file_);
    const std::string begin = R"(id="report-data">)";
    const auto from = page.find(begin) + begin.size();
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "report.html";
  Registrar registrar_;
  TermRegistry terms_;
  StageDriver driver_ = StageDriver::of<WriteReportStage>(
      {{"file", OptionScalar(file_.string())}, {"points", OptionScalar(std::int64_t{1000})}});
};

const Json kSummary = {{"trusted", true}, {"stages", Json::array()}, {"rig", "default"}};

TEST_F(WriteReport, WritesThePageWhenTheRunIsRecorded) {
  driver_.feed(beams(), turning(), nominal_calibration(default_rig()));
  driver_.finish();
  EXPECT_FALSE(std::filesystem::exists(file_));
  EXPECT_THAT(driver_.report().written, ElementsAre(file_));
  driver_.report().when_recorded(kSummary);
  const Json data = data_of_page();
  EXPECT_EQ(data.at("summary"), kSummary);
  EXPECT_EQ(data.at("calibration").at("lasers"), Json({"laser1", "laser2", "laser3"}));
  EXPECT_EQ(data.at("cloud").at("points"), 1000);
  EXPECT_EQ(data.at("cloud").at("of"), 3000);
  EXPECT_EQ(data.at("motion").at("time").size(), 101U);
}

TEST_F(WriteReport, ShowsParametersInMillimetresAndDegreesNextToTheRigs) {
  Calibration calibration = nominal_calibration(default_rig());
  calibration.lasers[1].tau = {"tau", "m", 0.2135, 0.0002, true};
  driver_.feed(beams(), turning(), calibration);
  driver_.finish();
  driver_.report().when_recorded(kSummary);
  const Json tau = data_of_page().at("calibration").at("parameters").at(5);
  EXPECT_EQ(tau.at("name"), "laser2.tau");
  EXPECT_EQ(tau.at("unit"), "mm");
  EXPECT_NEAR(tau.at("value").get<double>(), 213.5, 1e-9);
  EXPECT_NEAR(tau.at("std_error").get<double>(), 0.2, 1e-9);
  EXPECT_NEAR(tau.at("nominal").get<double>(), 200, 1e-9);
}

TEST_F(WriteReport, ShowsCorrelationsOfTheCovariance) {
  Calibration calibration = nominal_calibration(default_rig());
  calibration.covariance_order = {"laser1.tau", "laser2.tau"};
  calibration.covariance = {4, -3, -3, 9};
  driver_.feed(beams(), turning(), calibration);
  driver_.finish();
  driver_.report().when_recorded(kSummary);
  EXPECT_EQ(data_of_page().at("calibration").at("correlations"), Json::parse("[[1.0,-0.5],[-0.5,1.0]]"));
}

TEST_F(WriteReport, OfARunWithoutMeasurementsHasNoCloud) {
  driver_.finish();
  driver_.report().when_recorded(kSummary);
  EXPECT_FALSE(data_of_page().contains("cloud"));
}

TEST_F(WriteReport, IsTitledByTheRecordingAndItsFolder) {
  Json summary = kSummary;
  summary["inputs"] = {{{"file", "/c/calibrate.yaml"}}, {{"file", "/data/day 3/hub.pcap"}}};
  driver_.finish();
  driver_.report().when_recorded(summary);
  EXPECT_EQ(data_of_page().at("title"), "day 3/hub.pcap");
}

TEST_F(WriteReport, HoldsThePlotsThatStagesDrew) {
  test::put_bytes(folder_ / "laser1_noise.svg", "<svg/>");
  Json summary = kSummary;
  summary["stages"] = {
      {{"tag", "diagnose.noise_model"},
       {"outputs", {(folder_ / "laser1_noise.svg").string(), (folder_ / "gone.svg").string()}}}};
  driver_.finish();
  driver_.report().when_recorded(summary);
  const Json plots = data_of_page().at("plots");
  ASSERT_EQ(plots.size(), 1U);
  EXPECT_EQ(plots.at(0).at("name"), "laser1_noise");
}

}  // namespace
}  // namespace crisp
