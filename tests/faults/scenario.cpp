// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/scenario.hpp"

#include <unistd.h>

#include <stdexcept>

#include "tests/support/source_dir.hpp"

namespace crisp::test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kSmall = {"grabber.simulate.duration=0.4s", "grabber.simulate.step=5deg",
                                         "grabber.simulate.min_rate=2Hz"};

constexpr const char* kStamps = R"(crisp: 1
pipeline:
  - stage: grabber.capture
    with: {file: "${input}"}
  - stage: diagnose.stamps
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

std::string in_words(const std::vector<std::string>& arguments) {
  std::string words = "crisp";
  for (const auto& argument : arguments) words += " " + argument;
  return words;
}

void run_or_throw(const std::vector<std::string>& arguments, const fs::path& folder) {
  const ProgramEnd end = run_program(arguments, folder);
  if (end.status == 0 || end.status == 3) return;
  throw std::runtime_error(in_words(arguments) + ": " + end.messages);
}

fs::path fast_folder() {
  const fs::path memory = "/dev/shm";
  return fs::is_directory(memory) && access(memory.c_str(), W_OK) == 0 ? memory : fs::temp_directory_path();
}

}  // namespace

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> kAll = {
      {"Simulate", "simulate.yaml", "", kSmall, {"grabber.simulate.seed=7"}, {}},
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
  };
  return kAll;
}

Files files_in(const fs::path& folder) {
  Files files;
  std::error_code none;
  if (!fs::is_directory(folder, none)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    files[entry.path().filename().string()] = bytes_of(entry.path());
  }
  return files;
}

Stage::Stage(const Scenario& scenario) : scenario_(scenario), folder_(fast_folder()) {
  make_inputs();
  inputs_ = files_in(input());
  run_or_throw(arguments(scenario_.earlier), folder_.path());
  earlier_ = files_in(output());
  const ProgramEnd end = run();
  if (end.status != 0 && end.status != 3)
    throw std::runtime_error(in_words(arguments()) + ": " + end.messages);
  status_ = end.status;
  calls_ = end.calls;
  undisturbed_ = files_in(output());
}

void Stage::make_inputs() const {
  const std::string configs = source_dir() + "/configs/";
  const std::string in = input().string();
  const auto run_config = [&](const std::string& text, const std::vector<std::string>& more) {
    put_bytes(folder_ / "make.yaml", text);
    std::vector<std::string> words = {"run", (folder_ / "make.yaml").string(), "-o", in, "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    run_or_throw(words, folder_.path());
  };
  std::vector<std::string> small;
  for (const auto& option : kSmall) small.insert(small.end(), {"--set", option});
  run_config(bytes_of(configs + "simulate.yaml"), small);
  const std::vector<std::string> capture = {"-i", in + "/hub.pcap"};
  run_config(bytes_of(configs + "assemble.yaml"),
             {"-i", in + "/hub.pcap", "--set", "calibration=" + in + "/truth.yaml"});
  std::string stamps = kStamps;
  run_config(stamps.replace(stamps.find("${input_dir}"), 12, in), capture);
  const bool is_text = scenario_.pipeline.starts_with("crisp:");
  std::string text = is_text ? scenario_.pipeline : bytes_of(configs + scenario_.pipeline);
  if (const auto at = text.find("${input_dir}"); at != std::string::npos) text.replace(at, 12, in);
  put_bytes(input() / "pipeline.yaml", text);
}

std::vector<std::string> Stage::arguments(const std::vector<std::string>& more) const {
  std::vector<std::string> words = {"run", (input() / "pipeline.yaml").string(), "-o", output().string(),
                                    "--quiet"};
  if (!scenario_.input.empty()) words.insert(words.end(), {"-i", (input() / scenario_.input).string()});
  for (const auto* options : {&scenario_.set, &more}) {
    for (std::string option : *options) {
      if (const auto at = option.find("${in}"); at != std::string::npos)
        option.replace(at, 5, input().string());
      words.insert(words.end(), {"--set", option});
    }
  }
  return words;
}

void Stage::reset() const {
  fs::remove_all(output());
  fs::create_directory(output());
  for (const auto& [name, bytes] : earlier_) put_bytes(output() / name, bytes);
}

ProgramEnd Stage::run(const Fault& fault) const { return run_program(arguments(), folder_.path(), fault); }

}  // namespace crisp::test
