// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <crisp/calibration_file.hpp>

#include "pipeline/files/findings_file.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::files;
using testing::ElementsAre;

TEST(Configs, DiagnoseNamesTheCauseAndExtendsTheCalibration) {
  const test::PipelineFixture fixture;
  fixture.simulate("made", {"duration=4s", "effects={laser2.range.offset: {c: 2cm}}"});
  const auto outcome = fixture.run("diagnose.yaml", fixture / "made/hub.pcap", "out");
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  EXPECT_THAT(
      outcome.files,
      ElementsAre("calibration.yaml", "calibration.yaml.provenance.json", "cloud.pcd",
                  "cloud.pcd.provenance.json", "diagnosis.json", "diagnosis.json.provenance.json",
                  "laser1_noise.svg", "laser1_noise.svg.provenance.json", "laser1_residuals.svg",
                  "laser1_residuals.svg.provenance.json", "laser1_stamps.svg",
                  "laser1_stamps.svg.provenance.json", "laser2_noise.svg", "laser2_noise.svg.provenance.json",
                  "laser2_residuals.svg", "laser2_residuals.svg.provenance.json", "laser2_stamps.svg",
                  "laser2_stamps.svg.provenance.json", "laser3_noise.svg", "laser3_noise.svg.provenance.json",
                  "laser3_residuals.svg", "laser3_residuals.svg.provenance.json", "laser3_stamps.svg",
                  "laser3_stamps.svg.provenance.json", "plate_stamps.svg", "plate_stamps.svg.provenance.json",
                  "report.html", "report.html.provenance.json", "scanner_residuals.svg",
                  "scanner_residuals.svg.provenance.json", "summary.json"));
  const auto diagnosis = nlohmann::json::parse(test::bytes_of(fixture / "out/diagnosis.json"));
  ASSERT_EQ(diagnosis["findings"].size(), 1U);
  EXPECT_EQ(diagnosis["findings"][0]["cause"], "range.offset");
  EXPECT_EQ(diagnosis["findings"][0]["scope"], "laser2");
  EXPECT_TRUE(diagnosis["findings"][0]["accepted"]);
  const Calibration calibration = read_calibration(fixture / "out/calibration.yaml");
  ASSERT_EQ(calibration.lasers.at(1).terms.size(), 1U);
  EXPECT_NEAR(calibration.lasers[1].terms[0].parameters.at(0).value, 0.02, 0.001);
  EXPECT_FALSE(calibration.quality.contains("rqe_after")) << "it was that of the calibration before";
  EXPECT_TRUE(calibration.quality.contains("rqe_undiagnosed"));
}

TEST(Configs, DiagnoseTakesAFolderOfCapturesOfOneScanner) {
  const test::PipelineFixture fixture;
  fixture.simulate("first", {"duration=4s", "effects={laser2.range.offset: {c: 2cm}}"});
  const std::string truth = (fixture / "first/truth.yaml").string();
  fixture.simulate("second",
                   {"duration=4s", "scene=hall", "seed=7", "start=1767229200s", "calibration=" + truth});
  const auto captures = fixture / "captures";
  std::filesystem::create_directory(captures);
  std::filesystem::rename(fixture / "first/hub.pcap", captures / "office.pcap");
  std::filesystem::rename(fixture / "second/hub.pcap", captures / "hall.pcap");
  const auto outcome = fixture.run("diagnose.yaml", captures, "out");
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  EXPECT_EQ(outcome.stage("calibrate.refine")["report"]["recordings"].size(), 2U);
  EXPECT_THAT(outcome.files, testing::IsSupersetOf({"cloud_0001.pcd", "cloud_0002.pcd"})) << "a place each";
  const auto diagnosis = nlohmann::json::parse(test::bytes_of(fixture / "out/diagnosis.json"));
  ASSERT_EQ(diagnosis["findings"].size(), 1U);
  EXPECT_EQ(diagnosis["findings"][0]["cause"], "range.offset");
  EXPECT_EQ(diagnosis["findings"][0]["scope"], "laser2");
  const auto& unobservable = diagnosis["unobservable"];
  EXPECT_TRUE(std::ranges::any_of(unobservable, [](const auto& one) {
    return one["cause"] == "encoder.eccentricity";
  })) << "the encoders of two simulations count from different zeros";
  const Calibration calibration = read_calibration(fixture / "out/calibration.yaml");
  ASSERT_EQ(calibration.lasers.at(1).terms.size(), 1U);
  EXPECT_NEAR(calibration.lasers[1].terms[0].parameters.at(0).value, 0.02, 0.001);
}

TEST(Configs, DiagnoseFindsNoiseOverIncidenceAndWeakEchoesThatASimulatedScannerThenHas) {
  const test::PipelineFixture fixture;
  const std::vector<std::string> causes = {"noise.incidence_dependent", "noise.remission_dependent"};
  const auto found_in = [&](const std::string& capture, const std::string& output) {
    const auto outcome = fixture.run("diagnose.yaml", fixture / capture, output);
    EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
    return read_findings(fixture / (output + "/diagnosis.json")).findings;
  };
  fixture.simulate(
      "made",
      {"duration=4s",
       "effects={laser1.noise.incidence_dependent: {spread: 9mm}, laser2.noise.remission_dependent: {jitter: 90mm}}"});
  const auto first = found_in("made/hub.pcap", "first");
  const auto simulated = fixture.run("like_real.yaml", fixture / "first", "again",
                                     {"grabber.simulate.duration=4s", "grabber.simulate.seed=77"});
  EXPECT_EQ(simulated.status, ExitStatus::done) << simulated.console;
  const auto second = found_in("again/hub.pcap", "second");
  const std::vector<double> truth = {9e-3, 90e-3};
  ASSERT_EQ(first.size(), truth.size());
  ASSERT_EQ(second.size(), truth.size());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_EQ(first[k].cause, causes[k]);
    EXPECT_EQ(second[k].cause, causes[k]);
    EXPECT_EQ(first[k].scope, second[k].scope);
    const Parameter& before = first[k].parameters.at(0);
    const Parameter& after = second[k].parameters.at(0);
    EXPECT_NEAR(before.value, truth[k], 4 * before.std_error) << causes[k];
    EXPECT_NEAR(after.value, before.value, 4 * after.std_error) << causes[k];
  }
}

}  // namespace
}  // namespace crisp
