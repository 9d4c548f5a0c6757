// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/files/yaml.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
namespace fs = std::filesystem;

bool is_pipeline(const fs::path& file) {
  return file.extension() == ".yaml" && read_yaml(file).find("pipeline") != nullptr;
}

TEST(Configs, AreRight) {
  int pipelines = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source_dir() + "/configs")) {
    if (!is_pipeline(entry.path())) continue;
    ++pipelines;
    // Neither errors nor warnings.
    const std::string command = CRISP_PROGRAM " validate " + entry.path().string() + " 2>&1 >/dev/null";
    EXPECT_EQ(std::system(("errors=$(" + command + ") && test -z \"$errors\"").c_str()), 0) << entry.path();
  }
  EXPECT_GT(pipelines, 0);
}

/// The commands in the comment that a file begins with, one line each: indented, and without what a wide gap
/// divides from them.
std::vector<std::string> commands_of(const fs::path& file) {
  constexpr std::string_view kBegin = "#   ";
  std::vector<std::string> commands;
  std::ifstream in(file);
  bool continues = false;
  for (std::string line; std::getline(in, line) && line.starts_with('#');) {
    if (!line.starts_with(kBegin)) continue;
    std::string text = line.substr(line.find_first_not_of(' ', 1));
    const bool goes_on = text.ends_with('\\');
    text = text.substr(0, std::min(text.find("   "), text.size() - (goes_on ? 1 : 0)));
    if (continues)
      commands.back() += text;
    else
      commands.push_back(text);
    continues = goes_on;
  }
  return commands;
}

/// The same command, which only checks its pipeline: validate needs no options of running.
std::string checking(std::string command) {
  const auto replace = [&](const std::string& pattern, const std::string& with) {
    command = std::regex_replace(command, std::regex(pattern), with);
  };
  replace("^crisp run ", CRISP_PROGRAM " validate ");
  replace(" --threads [0-9]+", "");
  replace("--rig my.yaml", "--rig configs/rig.yaml");
  replace("^crisp ", CRISP_PROGRAM " ");
  return command;
}

TEST(Configs, BeginWithCommandsThatAreRight) {
  int commands = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source_dir() + "/configs")) {
    if (entry.path().extension() != ".yaml") continue;
    for (const auto& command : commands_of(entry.path())) {
      if (!command.starts_with("crisp run ")) continue;
      ++commands;
      const std::string shell = "cd " + source_dir() + " && " + checking(command) + " 2>&1 >/dev/null";
      EXPECT_EQ(std::system(("errors=$(" + shell + ") && test -z \"$errors\"").c_str()), 0)
          << entry.path() << ": " << command;
    }
  }
  EXPECT_GT(commands, 25);
}

TEST(Configs, SimulateTheDevicesByTheirCommands) {
  const fs::path folder = fs::temp_directory_path() / ("crisp-devices-" + std::to_string(getpid()));
  for (const auto& entry : fs::directory_iterator(source_dir() + "/configs/devices")) {
    for (auto command : commands_of(entry.path())) {
      command = std::regex_replace(command, std::regex("^crisp|-o out"), "");
      command = fmt::format("cd {} && {}{} -o {} --set grabber.simulate.duration=0.5s >/dev/null",
                            source_dir(), CRISP_PROGRAM, command, folder.string());
      EXPECT_EQ(std::system(command.c_str()), 0) << entry.path() << ": " << command;
      EXPECT_GT(fs::file_size(folder / "hub.pcap"), 10000U) << entry.path();
      fs::remove_all(folder);
    }
  }
}

}  // namespace
}  // namespace crisp
