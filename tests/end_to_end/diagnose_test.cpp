// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "pipeline/files/calibration_file.hpp"
#include "tests/end_to_end/workshop.hpp"

namespace crisp {
namespace {

using testing::ElementsAre;

TEST(Configs, DiagnoseNamesTheCauseAndExtendsTheCalibration) {
  const test::Workshop workshop;
  workshop.simulate("made", {"duration=4s", "effects={laser2.range.offset: {c: 2cm}}"});
  const auto outcome = workshop.run("diagnose.yaml", workshop / "made/hub.pcap", "out");
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.told;
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
                  "summary.json"));
  const auto diagnosis = nlohmann::json::parse(test::bytes_of(workshop / "out/diagnosis.json"));
  ASSERT_EQ(diagnosis["findings"].size(), 1U);
  EXPECT_EQ(diagnosis["findings"][0]["cause"], "range.offset");
  EXPECT_EQ(diagnosis["findings"][0]["scope"], "laser2");
  EXPECT_TRUE(diagnosis["findings"][0]["accepted"]);
  const Calibration calibration = read_calibration(workshop / "out/calibration.yaml");
  ASSERT_EQ(calibration.lasers.at(1).terms.size(), 1U);
  EXPECT_NEAR(calibration.lasers[1].terms[0].parameters.at(0).value, 0.02, 0.001);
  EXPECT_FALSE(calibration.quality.contains("rqe_after")) << "it was that of the calibration before";
  EXPECT_TRUE(calibration.quality.contains("rqe_undiagnosed"));
}

TEST(Configs, DiagnoseTakesAFolderOfCapturesOfOneScanner) {
  const test::Workshop workshop;
  workshop.simulate("first", {"duration=4s", "effects={laser2.range.offset: {c: 2cm}}"});
  const std::string truth = (workshop / "first/truth.yaml").string();
  workshop.simulate("second",
                    {"duration=4s", "scene=hall", "seed=7", "start=1767229200s", "calibration=" + truth});
  const auto captures = workshop / "captures";
  std::filesystem::create_directory(captures);
  std::filesystem::rename(workshop / "first/hub.pcap", captures / "office.pcap");
  std::filesystem::rename(workshop / "second/hub.pcap", captures / "hall.pcap");
  const auto outcome = workshop.run("diagnose.yaml", captures, "out");
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.told;
  EXPECT_EQ(outcome.stage("calibrate.refine")["report"]["recordings"].size(), 2U);
  EXPECT_THAT(outcome.files, testing::IsSupersetOf({"cloud_0001.pcd", "cloud_0002.pcd"})) << "a place each";
  const auto diagnosis = nlohmann::json::parse(test::bytes_of(workshop / "out/diagnosis.json"));
  ASSERT_EQ(diagnosis["findings"].size(), 1U);
  EXPECT_EQ(diagnosis["findings"][0]["cause"], "range.offset");
  EXPECT_EQ(diagnosis["findings"][0]["scope"], "laser2");
  const auto& unobservable = diagnosis["unobservable"];
  EXPECT_TRUE(std::ranges::any_of(unobservable, [](const auto& one) {
    return one["cause"] == "encoder.eccentricity";
  })) << "the encoders of two simulations count from different zeros";
  const Calibration calibration = read_calibration(workshop / "out/calibration.yaml");
  ASSERT_EQ(calibration.lasers.at(1).terms.size(), 1U);
  EXPECT_NEAR(calibration.lasers[1].terms[0].parameters.at(0).value, 0.02, 0.001);
}

}  // namespace
}  // namespace crisp
