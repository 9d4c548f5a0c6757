// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/run_inspector.hpp"

#include <gmock/gmock.h>

#include <crisp/error.hpp>

#include "pipeline/app/run_record.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::report;
using testing::HasSubstr;

RunRecord some_run() {
  RunRecord record;
  record.command = "crisp run calibrate.yaml -i hub.pcap";
  record.pipeline_file = "calibrate.yaml";
  record.started = "2026-11-28T19:48:07Z";
  record.seconds = 4.25;
  record.exit_status = 3;
  NodeResult node{.tag = "calibrate.refine", .stage = "calibrate.refine"};
  node.report.caveats = {"views disagree"};
  node.report.warnings = {"the encoder counts clockwise"};
  node.report.written = {"out/calibration.yaml"};
  record.nodes = {node};
  record.options = {nlohmann::ordered_json::object()};
  return record;
}

TEST(RunInspector, PrintsVerdictCaveatsAndOutputs) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "summary.json", summary_json(some_run()).dump(2));
  const Inspection inspection = run_inspector().inspect(folder / "summary.json", {});
  for (const char* part : {"crisp run calibrate.yaml -i hub.pcap",
                           "began 2026-11-28T19:48:07Z, took 4.2 s, exit status 3, untrusted",
                           "calibrate.refine: untrusted: views disagree",
                           "calibrate.refine: warning: the encoder counts clockwise",
                           "calibrate.refine wrote out/calibration.yaml"}) {
    EXPECT_THAT(inspection.text, HasSubstr(part));
  }
  EXPECT_EQ(inspection.data["exit_status"], 3);
}

TEST(RunInspector, RecognizesASummaryByItsFirstKeys) {
  EXPECT_TRUE(run_inspector().recognises(summary_json(some_run()).dump(2)));
  EXPECT_TRUE(run_inspector().recognises(summary_json(some_run()).dump()));
  EXPECT_FALSE(run_inspector().recognises(R"({"crisp":1,"findings":[]})"));
  EXPECT_FALSE(run_inspector().recognises("crisp: 1\nlasers:\n"));
}

TEST(RunInspector, RefusesADamagedSummary) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "summary.json", R"({"crisp": "0.1.0", "command": "crisp", "pipeline": "p"})");
  test::put_bytes(folder / "half.json", summary_json(some_run()).dump().substr(0, 200));
  for (const char* file : {"summary.json", "half.json"}) {
    try {
      run_inspector().inspect(folder / file, {});
      FAIL() << file;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::string(file) + " is damaged"));
    }
  }
}

}  // namespace
}  // namespace crisp
