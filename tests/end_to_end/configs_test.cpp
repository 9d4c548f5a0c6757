// SPDX-License-Identifier: BSD-3-Clause
// The pipelines that come with crisp, run as they are.
#include <gmock/gmock.h>

#include <algorithm>

#include "pipeline/data/degree.hpp"
#include "pipeline/files/calibration_file.hpp"
#include "pipeline/files/yaml.hpp"
#include "tests/end_to_end/calibration_errors.hpp"
#include "tests/end_to_end/workshop.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

TEST(Configs, EachPipelineHasATestThatRunsIt) {
  std::vector<std::string> pipelines;
  for (const auto& entry : fs::directory_iterator(CRISP_SOURCE_DIR "/configs")) {
    if (entry.path().extension() != ".yaml" || !read_yaml(entry.path()).find("pipeline")) continue;
    pipelines.push_back(entry.path().filename().string());
  }
  EXPECT_THAT(pipelines,
              UnorderedElementsAre("assemble.yaml", "basin.yaml", "bound.yaml", "calibrate.yaml",
                                   "figures.yaml", "monte_carlo.yaml", "picture.yaml", "simulate.yaml"));
}

TEST(Configs, SimulateWritesACaptureAndItsTruthAndAssembleMakesACloudOfThem) {
  const test::Workshop workshop;
  const auto simulated = workshop.run("simulate.yaml", {}, "made", {"grabber.simulate.duration=1s"});
  EXPECT_EQ(simulated.status, ExitStatus::done) << simulated.told;
  EXPECT_THAT(simulated.files, ElementsAre("hub.pcap", "hub.pcap.provenance.json", "summary.json",
                                           "truth.yaml", "truth.yaml.provenance.json"));

  const auto assembled = workshop.assemble("made", "out");
  EXPECT_EQ(assembled.status, ExitStatus::done) << assembled.told;
  EXPECT_THAT(assembled.files, ElementsAre("cloud.pcd", "cloud.pcd.provenance.json", "summary.json"));
  // 1 s at 50 Hz of 3 lasers with 541 beams each, less the part of a turn at either end, in a closed room.
  ASSERT_NE(assembled.cloud, nullptr);
  EXPECT_GT(assembled.cloud->size(), 48U * 3 * 541);
  EXPECT_LE(assembled.cloud->size(), 50U * 3 * 541);
  EXPECT_THAT(test::bytes_of(workshop / "out/cloud.pcd").substr(0, 1000),
              testing::HasSubstr("DATA binary_compressed"));
}

TEST(Configs, CalibrateFindsTheScannerAndMakesTheCloudFromACaptureAlone) {
  const test::Workshop workshop;
  workshop.simulate("made", {"duration=3s"});
  const auto outcome = workshop.run("calibrate.yaml", workshop / "made/hub.pcap", "out");
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.told;
  EXPECT_THAT(outcome.files, ElementsAre("calibration.yaml", "calibration.yaml.provenance.json", "cloud.pcd",
                                         "cloud.pcd.provenance.json", "summary.json"));
  const auto errors = test::errors_of(read_calibration(workshop / "out/calibration.yaml"),
                                      read_calibration(workshop / "made/truth.yaml"));
  EXPECT_LE(errors.tau, 0.003);
  EXPECT_LE(errors.lambda, 0.3 * kDegree);
  EXPECT_LE(errors.alpha, 0.3 * kDegree);
  EXPECT_LE(errors.eta, 0.4e-3);
  const auto& quality = outcome.stage("calibrate.refine")["report"]["quality"];
  EXPECT_LT(quality["rqe_after"].get<double>(), quality["rqe_before"].get<double>());
  ASSERT_NE(outcome.cloud, nullptr);
  EXPECT_EQ(outcome.cloud->size(), outcome.stage("assemble.deskew")["report"]["points"]);
}

TEST(Configs, PictureShowsTheCloudBeforeAndAfterACalibration) {
  const test::Workshop workshop;
  workshop.simulate("made", {"duration=1s"});
  const auto drawn = workshop.run("picture.yaml", workshop / "made/hub.pcap", "out",
                                  {"calibration=" + (workshop / "made/truth.yaml").string()});
  EXPECT_EQ(drawn.status, ExitStatus::done) << drawn.told;
  EXPECT_THAT(drawn.files, ElementsAre("after.png", "after.png.provenance.json", "before.png",
                                       "before.png.provenance.json", "summary.json"));
  EXPECT_NE(test::bytes_of(workshop / "out/before.png"), test::bytes_of(workshop / "out/after.png"));
}

TEST(Configs, FiguresWritesTheColumnsOfThePapersFigures) {
  const test::Workshop workshop;
  const auto outcome = workshop.run("figures.yaml", {}, "out");
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.told;
  EXPECT_THAT(outcome.files,
              testing::IsSupersetOf({"fig4_beam.dat", "fig5_surface.dat", "fig6_tau.dat", "fig6_alpha.dat",
                                     "fig6_optimum.dat", "fig7_eta.dat", "summary.json"}));
}

TEST(Configs, BoundWritesTheLeastErrorOfEachParameter) {
  const test::Workshop workshop;
  const auto outcome = workshop.run("bound.yaml", {}, "out", {"study.bound.duration=1s"});
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.told;
  EXPECT_THAT(outcome.files, ElementsAre("bound.csv", "bound.csv.provenance.json", "summary.json"));
  const std::string bounds = test::bytes_of(workshop / "out/bound.csv");
  EXPECT_EQ(std::ranges::count(bounds, '\n'), 1 + 11)
      << "lambda, tau, alpha, eta of three lasers but lambda 1";
  const auto& report = outcome.stage("study.bound")["report"];
  std::size_t on_planes = 0;
  for (const auto& plane : report["planes"]) on_planes += plane["beams"].get<std::size_t>();
  EXPECT_EQ(on_planes, report["beams"]);
  EXPECT_EQ(report["no_echo"], 0) << "the office is closed";
  EXPECT_THAT(report["unobservable"], testing::IsEmpty());
}

TEST(Configs, MonteCarloWritesEveryRunAndTheTable) {
  const test::Workshop workshop;
  const auto outcome = workshop.run("monte_carlo.yaml", {}, "out", {"runs=1"});
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.told;
  EXPECT_THAT(outcome.files, ElementsAre("monte_carlo.csv", "monte_carlo.csv.provenance.json", "summary.json",
                                         "table1.txt", "table1.txt.provenance.json"));
  const std::string runs = test::bytes_of(workshop / "out/monte_carlo.csv");
  EXPECT_EQ(std::ranges::count(runs, '\n'), 1 + 11) << "lambda, tau, alpha, eta of three lasers but lambda 1";
}

TEST(Configs, AssembleSaysWhichCalibrationItMisses) {
  const test::Workshop workshop;
  workshop.simulate("made", {"duration=1s", "step=2deg"});
  const auto none = workshop.run("assemble.yaml", workshop / "made/hub.pcap", "out");
  EXPECT_EQ(none.status, ExitStatus::failed);
  EXPECT_THAT(none.told, testing::HasSubstr("there is no calibration " + (workshop / "out").string()));
  EXPECT_THAT(none.files, testing::IsEmpty());
}

}  // namespace
}  // namespace crisp
