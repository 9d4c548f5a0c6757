// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/stage.hpp"

#include <unistd.h>

#include <stdexcept>
#include <utility>

#include "tests/support/source_dir.hpp"

namespace crisp::test {
namespace {

namespace fs = std::filesystem;

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

Stage::Stage(Scenario scenario) : scenario_(std::move(scenario)), folder_(fast_folder()) {
  fs::create_directory(input());
  if (scenario_.command == Command::record)
    scanner_ = std::make_unique<EmulatedScanner>(input() / "rig.yaml");
  else
    make_inputs();
  inputs_ = list_files(input());
  run_or_throw(arguments(scenario_.earlier), folder_.path());
  earlier_ = list_files(output());
  const ProgramEnd end = run();
  if (end.status != 0 && end.status != 3)
    throw std::runtime_error(in_words(arguments()) + ": " + end.messages);
  status_ = end.status;
  calls_ = end.calls;
  lasted_ = end.lasted;
  undisturbed_ = list_files(output());
}

void Stage::make_inputs() const {
  const std::string configs = source_dir() + "/configs/";
  const std::string in = input().string();
  const auto run_config = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", configs + name, "-o", in, "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    run_or_throw(words, folder_.path());
  };
  std::vector<std::string> small;
  for (const auto& option : small_recording()) small.insert(small.end(), {"--set", option});
  run_config("simulate.yaml", small);
  run_config("assemble.yaml", {"-i", in + "/hub.pcap", "--set", "calibration=" + in + "/truth.yaml"});
  fs::create_directory(input() / "recordings");
  for (const auto* name : {"one.pcap", "two.pcap"})
    fs::copy_file(input() / "hub.pcap", input() / "recordings" / name);
  const bool is_text = scenario_.pipeline.starts_with("crisp:");
  std::string text = is_text ? scenario_.pipeline : bytes_of(configs + scenario_.pipeline);
  if (const auto at = text.find("${input_dir}"); at != std::string::npos) text.replace(at, 12, in);
  put_bytes(input() / "pipeline.yaml", text);
}

std::vector<std::string> Stage::arguments(const std::vector<std::string>& more) const {
  const std::string pipeline = (input() / "pipeline.yaml").string();
  std::vector<std::string> words;
  switch (scenario_.command) {
    case Command::run:
      words = {"run", pipeline};
      break;
    case Command::batch:
      words = {"batch", pipeline, "--jobs", "1"};
      break;
    case Command::record:
      words = {"record", "--rig", (input() / "rig.yaml").string(), "--duration", "0.1s"};
  }
  words.insert(words.end(), {"-o", output().string(), "--quiet"});
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
  for (const auto& [name, bytes] : earlier_) {
    fs::create_directories((output() / name).parent_path());
    put_bytes(output() / name, bytes);
  }
}

ProgramEnd Stage::run(const Fault& fault) const { return run_program(arguments(), folder_.path(), fault); }

ProgramEnd Stage::run_next() const {
  ProgramEnd end = run();
  if (scenario_.command != Command::batch || end.status != 1) return end;
  return run_program({"batch", "retry", output().string(), "--jobs", "1", "--quiet"}, folder_.path());
}

}  // namespace crisp::test
