// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/scenario.hpp"

namespace crisp::test {
namespace {

constexpr const char* kStamps = R"(crisp: 1
pipeline:
  - stage: grabber.capture
    with: {file: "${input}"}
  - stage: diagnose.clocks
    with: {folder: "${output}"}
  - stage: clock.convex_hull
  - stage: calibrate.load
    with: {file: "${input_dir}/truth.yaml"}
  - stage: write.findings
    with: {file: "${output}/diagnosis.json"}
  - stage: write.calibration
    with: {file: "${output}/calibration.yaml"}
  - stage: write.measurements
    with: {file: "${output}/raw.pcd"}
)";

constexpr const char* kRecord = R"(crisp: 1
pipeline:
  - stage: grabber.capture
    with: {file: "${input}"}
  - stage: write.capture
    with: {file: "${output}/copy.pcap", safe_after: 0.1s}
)";

constexpr const char* kThin = R"(crisp: 1
pipeline:
  - stage: grabber.cloud
    with: {file: "${input}"}
  - stage: filter.voxel
  - stage: write.pcd
    with: {file: "${output}/thin.pcd", split_points: 400}
)";

constexpr const char* kRevolutions = R"(crisp: 1
pipeline:
  - stage: grabber.capture
    with: {file: "${input}"}
  - stage: clock.online
  - stage: assemble.deskew
  - stage: assemble.revolutions
    with: {turns: 0.25}
  - stage: write.clouds
    with: {file: "${output}/cloud.pcd"}
)";

}  // namespace

const std::vector<std::string>& small_recording() {
  static const std::vector<std::string> kSmall = {"grabber.simulate.duration=0.4s",
                                                  "grabber.simulate.lasers.step=5deg",
                                                  "grabber.simulate.motion.min_rate=2Hz"};
  return kSmall;
}

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> kAll = {
      {"Simulate", "simulate.yaml", "", small_recording(), {"grabber.simulate.seed=7"}, {}},
      {"Assemble",
       "assemble.yaml",
       "hub.pcap",
       {"calibration=${in}/truth.yaml"},
       {"write.pcd.format=ascii"},
       {}},
      {"Picture",
       "picture.yaml",
       "hub.pcap",
       {"calibration=${in}/truth.yaml"},
       {"before.depth=[-0.2m, 0.2m]", "after.depth=[-0.2m, 0.2m]"},
       {}},
      {"Stamps",
       kStamps,
       "hub.pcap",
       {},
       {"write.measurements.format=binary", "grabber.capture.duration=0.3s"},
       {}},
      {"Record", kRecord, "hub.pcap", {}, {"grabber.capture.duration=0.2s"}, "copy.pcap"},
      {"Thin", kThin, "cloud.pcd", {"filter.voxel.size=0.2m"}, {"filter.voxel.size=0.05m"}, {}},
      {"Revolutions", kRevolutions, "hub.pcap", {}, {"assemble.revolutions.turns=0.2"}, {}},
      {.name = "Batch",
       .pipeline = "assemble.yaml",
       .input = "recordings",
       .set = {"calibration=${in}/truth.yaml"},
       .earlier = {"write.pcd.format=ascii"},
       .command = Command::batch},
      {.name = "LiveRecord", .grows = "hub.pcap", .command = Command::record},
  };
  return kAll;
}

}  // namespace crisp::test
