// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/simulate_stage.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <crisp/atomic_file.hpp>
#include <crisp/calibration_file.hpp>
#include <crisp/effect_catalogue.hpp>
#include <crisp/error.hpp>
#include <crisp/pipeline.hpp>
#include <crisp/runner.hpp>

#include "pipeline/files/findings_file.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
using namespace crisp::simulate;
namespace fs = std::filesystem;
using testing::HasSubstr;

/// Takes what the simulator gives, and counts it.
struct Tally final : Stage {
  static inline int scans = 0;
  static inline int readings = 0;
  static inline std::int64_t last = 0;
  static inline std::atomic<bool>* stop_after_100 = nullptr;
  static void describe(StageDescription<Tally>& d) {
    d.name("test.tally").summary("counts").takes<Scan>().takes<PlateReading>();
  }
  void process(const Inputs& in, Outputs&, Context&) override {
    const auto* scan = in.find<Scan>();
    const auto receipt = scan ? scan->receipt_ns : in.get<PlateReading>().receipt_ns;
    EXPECT_GE(receipt, last);
    last = receipt;
    ++(scan ? scans : readings);
    if (stop_after_100 && scans + readings == 100) *stop_after_100 = true;
  }
};

class SimulateStageTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("crisp_simulate_stage_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    Tally::scans = Tally::readings = 0;
    Tally::stop_after_100 = nullptr;
    register_built_in(terms_);
    registrar_.attach(terms_);
    register_simulate(registrar_);
    registrar_.stage<Tally>();
    run_.registrar = &registrar_;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::vector<NodeResult> run(const std::string& options, const RunHooks& hooks = {}) {
    Tally::last = 0;
    const fs::path file = folder_ / "pipeline.yaml";
    std::ofstream(file) << "crisp: 1\npipeline:\n  - stage: grabber.simulate\n    with: {" << options
                        << "}\n  - stage: test.tally\n";
    auto loaded = load_pipeline(file, {.output = folder_}, run_);
    return run_pipeline(loaded.pipeline, run_, hooks);
  }
  std::string complaint(const std::string& options) {
    try {
      run(options);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  }
  static std::string read(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }

  fs::path folder_;
  TermRegistry terms_;
  Registrar registrar_;
  RunSettings run_;
};

TEST_F(SimulateStageTest, GivesScansAndReadingsInTheOrderOfReceipt) {
  const auto results = run("duration: 0.5s, scene: hall, lasers: {mirror_slowest: 0, mirror_wander: 0}");
  EXPECT_NEAR(Tally::scans, 3 * 25, 3);
  EXPECT_NEAR(Tally::readings, 0.7 * 500, 2);
  EXPECT_EQ(results[0].report.section["scene"], "hall");
}

TEST_F(SimulateStageTest, WritesTheSameCaptureAndTruthForTheSameSeed) {
  run("duration: 0.2s, capture: a/hub.pcap, truth: a/truth.yaml");
  run("duration: 0.2s, capture: b/hub.pcap, truth: b/truth.yaml");
  run("duration: 0.2s, capture: c/hub.pcap, truth: c/truth.yaml, seed: 2");
  EXPECT_GT(fs::file_size(folder_ / "a/hub.pcap"), 30'000U);
  EXPECT_EQ(read(folder_ / "a/hub.pcap"), read(folder_ / "b/hub.pcap"));
  EXPECT_EQ(read(folder_ / "a/truth.yaml"), read(folder_ / "b/truth.yaml"));
  EXPECT_NE(read(folder_ / "a/hub.pcap"), read(folder_ / "c/hub.pcap"));
  const Calibration truth = read_calibration(folder_ / "a/truth.yaml");
  EXPECT_NE(truth.lasers[1].tau.value, 0.20) << "drawn around nominal";
  EXPECT_NEAR(truth.lasers[1].tau.value, 0.20, 0.02);
}

TEST_F(SimulateStageTest, RunsThePipelineThatUsersCopy) {
  const fs::path file = fs::path(source_dir()) / "configs/simulate.yaml";
  auto loaded =
      load_pipeline(file, {.output = folder_ / "out", .set = {"grabber.simulate.duration=0.2s"}}, run_);
  run_pipeline(loaded.pipeline, run_);
  EXPECT_GT(fs::file_size(folder_ / "out/hub.pcap"), 30'000U);
  EXPECT_EQ(read_calibration(folder_ / "out/truth.yaml").lasers.size(), 3U);
}

TEST_F(SimulateStageTest, TakesItsTruthFromACalibration) {
  Calibration truth = nominal_calibration(default_rig());
  truth.lasers[2].alpha.value = 0.0123;
  write_calibration(folder_ / "known.yaml", truth);
  run("duration: 0.1s, calibration: known.yaml, truth: truth.yaml");
  EXPECT_EQ(read_calibration(folder_ / "truth.yaml").lasers[2].alpha.value, 0.0123);
  truth.lasers.pop_back();
  write_calibration(folder_ / "other.yaml", truth);
  EXPECT_THAT(complaint("duration: 0.1s, calibration: other.yaml"),
              HasSubstr("not a calibration of this rig"));
}

TEST_F(SimulateStageTest, WritesItsEffectsIntoTheTruth) {
  run("duration: 0.1s, truth: truth.yaml, effects: {encoder.eccentricity: {a: 0.1deg}, laser2.mirror.cone: {kappa: 3mrad}, laser3.noise.heavy_tail: {share: 1%}, plate.clock.drift: {drift: 1e-6}}");
  const Calibration truth = read_calibration(folder_ / "truth.yaml");
  ASSERT_EQ(truth.plate_terms.size(), 1U);
  EXPECT_EQ(truth.plate_terms[0].term, "encoder.eccentricity");
  EXPECT_EQ(truth.plate_terms[0].parameters.at(0).unit, "rad");
  ASSERT_EQ(truth.lasers[1].terms.size(), 1U);
  EXPECT_EQ(truth.lasers[1].terms[0].parameters.at(0).value, 3e-3);
  EXPECT_TRUE(truth.lasers[2].terms.empty());
  EXPECT_EQ(truth.provenance.at("effect laser3.noise.heavy_tail.share"), "0.01");
  EXPECT_EQ(truth.provenance.at("plate.clock.drift"), "1e-06");
  EXPECT_NO_THROW(SensorModel(truth, terms_)) << "assembly takes it as it is";
}

TEST_F(SimulateStageTest, PutsWhatWasFoundInTheScannerBelowWhatIsRequested) {
  Findings findings;
  findings.findings = {{.cause = "mirror.cone",
                        .scope = "laser2",
                        .parameters = {{.name = "kappa", .unit = "rad", .value = 3e-3}},
                        .accepted = true},
                       {.cause = "encoder.eccentricity",
                        .scope = "plate",
                        .parameters = {{.name = "a", .unit = "rad", .value = 1e-3}},
                        .accepted = true},
                       {.cause = "scene.moving", .scope = "plate", .parameters = {}, .accepted = true}};
  write_file(folder_ / "diagnosis.json", findings_json(findings));
  const auto results = run(
      "duration: 0.1s, truth: truth.yaml, findings: diagnosis.json, effects: {laser2.mirror.cone: {kappa: 4mrad}}");
  const Calibration truth = read_calibration(folder_ / "truth.yaml");
  EXPECT_EQ(truth.plate_terms.at(0).parameters.at(0).value, 1e-3);
  EXPECT_EQ(truth.lasers.at(1).terms.at(0).parameters.at(0).value, 4e-3);
  EXPECT_THAT(results[0].report.lines, testing::Contains(HasSubstr("scene.moving of plate")));
  EXPECT_EQ(results[0].report.section["findings_simulated"], 2);
}

TEST_F(SimulateStageTest, RefusesFindingsThatAreNotThereOrOfAnotherRig) {
  EXPECT_THAT(complaint("findings: nowhere.json"), HasSubstr("nowhere.json"));
  Findings findings;
  findings.findings = {{.cause = "mirror.cone", .scope = "laser9", .parameters = {}, .accepted = true}};
  write_file(folder_ / "diagnosis.json", findings_json(findings));
  EXPECT_THAT(complaint("findings: diagnosis.json"), HasSubstr("laser9"));
  std::ofstream(folder_ / "damaged.json") << findings_json(findings).substr(0, 100);
  EXPECT_THAT(complaint("findings: damaged.json"), HasSubstr("damaged.json:"));
}

TEST_F(SimulateStageTest, ReadsEveryTermBackFromTheTruth) {
  std::string effects;
  for (const auto& name : terms_.names()) effects += (effects.empty() ? "" : ", ") + name + ": {}";
  run("duration: 0.1s, lasers: {first_angle: 0deg, last_angle: 10deg}, truth: truth.yaml, effects: {" +
      effects + "}");
  const Calibration truth = read_calibration(folder_ / "truth.yaml");
  EXPECT_EQ(truth.plate_terms.size() + truth.lasers[0].terms.size(), terms_.names().size() - 2)
      << "clocks drift, and mirrors turn, as devices' own";
  const SensorModel model(truth, terms_);
  for (const auto& term : truth.plate_terms) {
    const auto& info = terms_.get(term.term)->info();
    for (std::size_t i = 0; i < info.parameters.size(); ++i) {
      EXPECT_EQ(term.parameters.at(i).unit, info.parameters[i].unit) << term.term;
      EXPECT_EQ(term.parameters.at(i).value, info.parameters[i].neutral) << term.term;
    }
  }
}

TEST_F(SimulateStageTest, LeavesNoFilesWhenItIsInterrupted) {
  std::atomic<bool> stop = false;
  Tally::stop_after_100 = &stop;
  EXPECT_THROW(run("duration: 100s, capture: out/hub.pcap, truth: out/truth.yaml", {.stop = &stop}),
               Interrupted);
  EXPECT_LT(Tally::scans + Tally::readings, 200);
  EXPECT_TRUE(fs::is_empty(folder_ / "out"));
}

TEST_F(SimulateStageTest, HasTheLossesOfItsFaults) {
  run("duration: 2s, lasers: {last_angle: -44deg}, faults: {silences: [laser2@0.5s+1s], restarts: [laser1@1s]}");
  EXPECT_NEAR(Tally::scans, 100 + 50 + 100, 6);
  EXPECT_THAT(complaint("duration: 2s, faults: {silences: [laser9@0.5s+1s]}"), HasSubstr("laser9"));
  EXPECT_THAT(complaint("duration: 2s, faults: {silences: [laser1@now+1s]}"), HasSubstr("laser2@3s+1s"));
  EXPECT_THAT(complaint("duration: 2s, faults: {silences: [laser1]}"), HasSubstr("laser2@3s+1s"));
}

TEST_F(SimulateStageTest, RefusesBeforeItRunsWhatMakesNoSense) {
  EXPECT_THAT(complaint("motion: {min_rate: 3Hz}"),
              HasSubstr("min_rate of 3 Hz is above its max_rate of 2 Hz; give"));
  EXPECT_THAT(complaint("lasers: {last_angle: -90deg}"), HasSubstr("field of view"));
  EXPECT_THAT(complaint("effects: {mirror.coin: {kappa: 3}}"), HasSubstr("did you mean 'mirror.cone'?"));
  EXPECT_THAT(complaint("effects: {mirror.coin: {kappa: 3}}"), HasSubstr("pipeline.yaml:4:"));
  EXPECT_THAT(complaint("effects: [mirror.cone]"), HasSubstr("a map of maps"));
  EXPECT_THAT(complaint("effects: {mirror.cone: 3}"), HasSubstr("is no map"));
  EXPECT_THAT(complaint("effects: {mirror.cone: {kappa: [3]}}"), HasSubstr("mirror.cone.kappa"));
  EXPECT_THAT(complaint("effects: {scene.moving: {}}"), HasSubstr("scene_file"));
  EXPECT_THAT(complaint("clocks: {stamp_lags: [1ms]}"),
              HasSubstr("1 stamp_lags for 3 lasers; give one a laser"));
  EXPECT_THAT(complaint("scene: beach"), HasSubstr("office"));
  EXPECT_THAT(complaint("scene_file: nowhere.yaml"), HasSubstr("nowhere.yaml"));
}

}  // namespace
}  // namespace crisp
