// SPDX-License-Identifier: BSD-3-Clause
// The pipelines that come with crisp, run as they are.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <fstream>
#include <thread>

#include <crisp/builtin.hpp>
#include <crisp/calibration_file.hpp>
#include <crisp/cloud_conversion.hpp>
#include <crisp/rig_file.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/files/yaml.hpp"
#include "tests/end_to_end/calibration_errors.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::data;
using namespace crisp::files;
namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

TEST(Configs, EachPipelineHasATestThatRunsIt) {
  std::vector<std::string> pipelines;
  for (const auto& entry : fs::directory_iterator(source_dir() + "/configs")) {
    if (entry.path().extension() != ".yaml" || !read_yaml(entry.path()).find("pipeline")) continue;
    pipelines.push_back(entry.path().filename().string());
  }
  EXPECT_THAT(pipelines,
              UnorderedElementsAre("assemble.yaml", "basin.yaml", "bound.yaml", "calibrate.yaml",
                                   "detection.yaml", "convert.yaml", "diagnose.yaml", "emulate.yaml",
                                   "figures.yaml", "like_real.yaml", "live.yaml", "monte_carlo.yaml",
                                   "picture.yaml", "record.yaml", "report.yaml", "simulate.yaml"));
}

TEST(Configs, SimulateWritesACaptureAndItsTruthAndAssembleMakesACloudOfThem) {
  const test::PipelineFixture fixture;
  const auto simulated = fixture.run("simulate.yaml", {}, "made", {"grabber.simulate.duration=1s"});
  EXPECT_EQ(simulated.status, ExitStatus::done) << simulated.console;
  EXPECT_THAT(simulated.files, ElementsAre("hub.pcap", "hub.pcap.provenance.json", "summary.json",
                                           "truth.yaml", "truth.yaml.provenance.json"));

  const auto assembled = fixture.assemble("made", "out");
  EXPECT_EQ(assembled.status, ExitStatus::done) << assembled.console;
  EXPECT_THAT(assembled.files, ElementsAre("cloud.pcd", "cloud.pcd.provenance.json", "summary.json"));
  // 1 s at 50 Hz of 3 lasers with 541 beams each, less the part of a turn at either end, in a closed room.
  ASSERT_NE(assembled.cloud, nullptr);
  EXPECT_GT(assembled.cloud->size(), 48U * 3 * 541);
  EXPECT_LE(assembled.cloud->size(), 50U * 3 * 541);
  EXPECT_THAT(test::bytes_of(fixture / "out/cloud.pcd").substr(0, 1000),
              testing::HasSubstr("DATA binary_compressed"));
}

TEST(Configs, CalibrateFindsTheScannerAndMakesTheCloudFromACaptureAlone) {
  const test::PipelineFixture fixture;
  fixture.simulate("made", {"duration=3s"});
  const auto outcome = fixture.run("calibrate.yaml", fixture / "made/hub.pcap", "out");
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  EXPECT_THAT(outcome.files, ElementsAre("calibration.yaml", "calibration.yaml.provenance.json", "cloud.pcd",
                                         "cloud.pcd.provenance.json", "report.html",
                                         "report.html.provenance.json", "summary.json"));
  const auto errors = test::errors_of(read_calibration(fixture / "out/calibration.yaml"),
                                      read_calibration(fixture / "made/truth.yaml"));
  EXPECT_LE(errors.tau, 0.003);
  EXPECT_LE(errors.lambda, 0.3 * kDegree);
  EXPECT_LE(errors.alpha, 0.3 * kDegree);
  EXPECT_LE(errors.eta, 0.4e-3);
  const auto& quality = outcome.stage("calibrate.refine")["report"]["quality"];
  EXPECT_LT(quality["rqe_after"].get<double>(), quality["rqe_before"].get<double>());
  EXPECT_LT(quality["rqe_after"].get<double>(), quality["rqe_unrefined"].get<double>() + 0.01) << "its judge";
  ASSERT_NE(outcome.cloud, nullptr);
  EXPECT_EQ(outcome.cloud->size(), outcome.stage("assemble.deskew")["report"]["points"]);
}

TEST(Configs, PictureShowsTheCloudBeforeAndAfterACalibration) {
  const test::PipelineFixture fixture;
  fixture.simulate("made", {"duration=1s"});
  const auto drawn = fixture.run("picture.yaml", fixture / "made/hub.pcap", "out",
                                 {"calibration=" + (fixture / "made/truth.yaml").string()});
  EXPECT_EQ(drawn.status, ExitStatus::done) << drawn.console;
  EXPECT_THAT(drawn.files, ElementsAre("after.png", "after.png.provenance.json", "before.png",
                                       "before.png.provenance.json", "summary.json"));
  EXPECT_NE(test::bytes_of(fixture / "out/before.png"), test::bytes_of(fixture / "out/after.png"));
}

TEST(Configs, ReportWritesThePageOfARun) {
  const test::PipelineFixture fixture;
  fixture.simulate("made", {"duration=1s"});
  const auto outcome = fixture.run("report.yaml", fixture / "made", "out");
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  EXPECT_THAT(test::bytes_of(fixture / "made/report.html"), testing::HasSubstr("grabber.simulate"));
}

TEST(Configs, ConvertWritesALasFileOfACloud) {
  const test::PipelineFixture fixture;
  fixture.simulate("made", {"duration=1s"});
  ASSERT_EQ(fixture.assemble("made", "cloud").status, ExitStatus::done);
  const std::string to = (fixture / "cloud.las").string();
  const auto outcome = fixture.run("convert.yaml", fixture / "cloud/cloud.pcd", "out", {"to=" + to});
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  EXPECT_THAT(test::bytes_of(to), testing::StartsWith("LASF"));
}

TEST(Configs, FiguresWritesTheColumnsOfThePapersFigures) {
  const test::PipelineFixture fixture;
  const auto outcome = fixture.run("figures.yaml", {}, "out");
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  EXPECT_THAT(outcome.files,
              testing::IsSupersetOf({"fig4_beam.dat", "fig5_surface.dat", "fig6_tau.dat", "fig6_alpha.dat",
                                     "fig6_optimum.dat", "fig7_eta.dat", "summary.json"}));
}

TEST(Configs, DetectionWritesFromWhichSizeOnEffectsShow) {
  const test::PipelineFixture fixture;
  const auto outcome = fixture.run("detection.yaml", {}, "out", {"study.detection.duration=2s"});
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  EXPECT_THAT(outcome.files, ElementsAre("detection.csv", "detection.csv.provenance.json", "summary.json"));
  const auto effects = outcome.stage("study.detection")["report"]["effects"];
  for (const char* cause : {"encoder.eccentricity", "laser1.mirror.cone", "laser3.range.incidence"}) {
    ASSERT_TRUE(effects.contains(cause)) << cause;
    EXPECT_GT(effects[cause].value("detectable", 0.0), 0) << cause;
  }
  EXPECT_FALSE(effects["laser1.mirror.cone"].contains("resolvable") &&
               effects["laser1.mirror.cone"]["resolvable"] < effects["laser1.mirror.cone"]["detectable"]);
}

TEST(Configs, BoundWritesTheLeastErrorOfEachParameter) {
  const test::PipelineFixture fixture;
  const auto outcome = fixture.run("bound.yaml", {}, "out", {"study.bound.duration=1s"});
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  EXPECT_THAT(outcome.files, ElementsAre("bound.csv", "bound.csv.provenance.json", "summary.json"));
  const std::string bounds = test::bytes_of(fixture / "out/bound.csv");
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
  const test::PipelineFixture fixture;
  const auto outcome = fixture.run("monte_carlo.yaml", {}, "out", {"runs=1"});
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  EXPECT_THAT(outcome.files, ElementsAre("monte_carlo.csv", "monte_carlo.csv.provenance.json", "summary.json",
                                         "table1.txt", "table1.txt.provenance.json"));
  const std::string runs = test::bytes_of(fixture / "out/monte_carlo.csv");
  EXPECT_EQ(std::ranges::count(runs, '\n'), 1 + 11) << "lambda, tau, alpha, eta of three lasers but lambda 1";
}

/// configs/loopback.yaml with ports that are free.
struct FreeLoopback {
  explicit FreeLoopback(const fs::path& file) {
    constexpr std::size_t kLimit = 1 << 20;
    std::string text = read_text_file(source_dir() + "/configs/loopback.yaml", kLimit);
    boost::asio::io_context context;
    const auto loopback = boost::asio::ip::make_address("127.0.0.1");
    std::vector<boost::asio::ip::tcp::acceptor> taken;  // at once, so that they differ
    for (const std::string usual : {"2121", "2122", "2123"}) {
      taken.emplace_back(context, boost::asio::ip::tcp::endpoint(loopback, 0));
      set_port(text, usual, std::to_string(taken.back().local_endpoint().port()));
    }
    const boost::asio::ip::udp::socket socket(context, boost::asio::ip::udp::endpoint(loopback, 0));
    plate = std::to_string(socket.local_endpoint().port());
    set_port(text, "4000", plate);
    std::ofstream(file) << text;
  }
  /// Whole numbers: a free port may have a usual one's digits in its own.
  static void set_port(std::string& text, const std::string& usual, const std::string& free) {
    const std::string line = "port: " + usual + "\n";
    text.replace(text.find(line), line.size(), "port: " + free + "\n");
  }
  std::string plate;  ///< port
};

/// configs/emulate.yaml for four seconds, in a thread of its own: on a busy machine some pass before anything
/// is placed.
struct Emulation {
  Emulation(const fs::path& rig, const std::string& plate_port)
      : thread([rig, plate_port] {
          Builtin builtin;
          RunRequest request{.file = source_dir() + "/configs/emulate.yaml", .quiet = true};
          request.arguments.rig = rig;
          request.arguments.set = {"grabber.simulate.duration=4s",
                                   "emulate.rig.plate_to=127.0.0.1:" + plate_port};
          run_command(request, builtin.registrar());
        }) {}
  ~Emulation() { thread.join(); }
  std::thread thread;
};

/// Where the machine is too busy to send telegrams at their pace, their stamps fit no clock of constant rate,
/// which is reported.
testing::Matcher<ExitStatus> done_as_well_as_may_be() {
  return testing::AnyOf(ExitStatus::done, ExitStatus::not_trusted);
}

TEST(Configs, EmulateIsAScannerOfWhichLiveMakesACloud) {
  const test::PipelineFixture fixture;
  fixture.simulate("made", {"duration=1s"});
  const FreeLoopback ports(fixture / "rig.yaml");
  const Emulation emulation(fixture / "rig.yaml", ports.plate);
  const auto live = fixture.run("live.yaml", {}, "out",
                                {"duration=3s", "calibration=" + (fixture / "made/truth.yaml").string()},
                                fixture / "rig.yaml");
  EXPECT_THAT(live.status, done_as_well_as_may_be()) << live.console;
  EXPECT_THAT(live.files,
              testing::IsSupersetOf({"cloud_0001.pcd", "cloud_0001.pcd.provenance.json", "summary.json"}));
  EXPECT_EQ(live.count("grabber.live", "laser1: lost telegrams, by their counter"), 0U);
  const auto cloud = cloud_of(read_pcd(fixture / "out/cloud_0001.pcd")).cloud;
  EXPECT_GT(cloud->size(), 541U);  // how many scans came in 3 s depends on the machine
}

TEST(Configs, LasersAndPlateMayBeGrabbedByAStageEach) {
  const test::PipelineFixture fixture;
  fixture.simulate("made", {"duration=1s"});
  const FreeLoopback ports(fixture / "rig.yaml");
  std::string text = read_text_file(source_dir() + "/configs/live.yaml", 1 << 20);
  const std::string both = "  - stage: grabber.live\n    with: {duration: \"${duration}\"}\n";
  ASSERT_NE(text.find(both), std::string::npos);
  text.replace(text.find(both), both.size(),
               "  - stage: grabber.sick\n    with: {duration: \"${duration}\"}\n"
               "  - stage: grabber.plate\n    with: {duration: \"${duration}\"}\n");
  std::ofstream(fixture / "each.yaml") << text;
  const Emulation emulation(fixture / "rig.yaml", ports.plate);
  const auto live = fixture.run((fixture / "each.yaml").string(), {}, "out",
                                {"duration=3s", "calibration=" + (fixture / "made/truth.yaml").string()},
                                fixture / "rig.yaml");
  EXPECT_THAT(live.status, done_as_well_as_may_be()) << live.console;
  EXPECT_GT(live.stage("clock.online")["taken"]["Scan"], 3);
  EXPECT_GT(live.stage("clock.online")["taken"]["PlateReading"], 3);
  EXPECT_THAT(live.files, testing::Contains("cloud_0001.pcd"));
}

TEST(Configs, RecordWritesACaptureOfWhichAssembleMakesACloud) {
  const test::PipelineFixture fixture;
  fixture.simulate("made", {"duration=1s"});
  const FreeLoopback ports(fixture / "rig.yaml");
  const Emulation emulation(fixture / "rig.yaml", ports.plate);
  const auto recorded =
      fixture.run("record.yaml", {}, "recorded", {"grabber.live.duration=3s"}, fixture / "rig.yaml");
  EXPECT_EQ(recorded.status, ExitStatus::done) << recorded.console;
  EXPECT_THAT(recorded.files, ElementsAre("hub.pcap", "hub.pcap.provenance.json", "summary.json"));
  const auto assembled =
      fixture.run("assemble.yaml", fixture / "recorded/hub.pcap", "out",
                  {"calibration=" + (fixture / "made/truth.yaml").string()}, fixture / "rig.yaml");
  EXPECT_THAT(assembled.status, done_as_well_as_may_be()) << assembled.console;
  EXPECT_EQ(assembled.stage("grabber.capture")["given"], recorded.stage("grabber.live")["given"])
      << "what was received is what is read";
  ASSERT_NE(assembled.cloud, nullptr);
  EXPECT_GT(assembled.cloud->size(), 541U);
}

TEST(Configs, EmulateHasTheRigOfLoopback) {
  Builtin builtin;
  RunSettings run;
  run.registrar = &builtin.registrar();
  load_pipeline(fs::path(source_dir() + "/configs/emulate.yaml"), {.only_validate = true}, run);
  const Rig loopback = read_rig(source_dir() + "/configs/loopback.yaml");
  ASSERT_EQ(run.rig.lasers.size(), loopback.lasers.size());
  for (std::size_t i = 0; i < loopback.lasers.size(); ++i) {
    EXPECT_EQ(run.rig.lasers[i].name, loopback.lasers[i].name);
    EXPECT_EQ(run.rig.lasers[i].address, loopback.lasers[i].address);
    EXPECT_EQ(run.rig.lasers[i].mount, loopback.lasers[i].mount);
    EXPECT_EQ(run.rig.lasers[i].nominal.lambda.value, loopback.lasers[i].nominal.lambda.value);
    EXPECT_EQ(run.rig.lasers[i].nominal.tau.value, loopback.lasers[i].nominal.tau.value);
  }
  EXPECT_EQ(run.rig.plate.address, loopback.plate.address);
  EXPECT_EQ(run.rig.plate.counts_per_revolution, loopback.plate.counts_per_revolution);
}

TEST(Configs, AssembleNamesTheMissingCalibration) {
  const test::PipelineFixture fixture;
  fixture.simulate("made", {"duration=1s", "lasers.step=2deg"});
  const auto none = fixture.run("assemble.yaml", fixture / "made/hub.pcap", "out");
  EXPECT_EQ(none.status, ExitStatus::failed);
  EXPECT_THAT(none.console, testing::HasSubstr("there is no calibration " + (fixture / "out").string()));
  EXPECT_THAT(none.console, testing::HasSubstr("--set calibrate.load.file=FILE"));
  EXPECT_THAT(none.files, ElementsAre("summary.json"));
}

}  // namespace
}  // namespace crisp
