// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <crisp/atomic_file.hpp>

#include "pipeline/files/yaml.hpp"

namespace crisp {

/// The exit status of a run of the program, and its output.
struct Outcome {
  int status = -1;
  std::string out;
  std::string error;
};

/// Runs the program as people do, in a folder of its own, with toy stages from a plugin.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "crisp-program-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    write_file(folder_ / "sum.yaml",
               "crisp: 1\n"
               "pipeline:\n"
               "  - {stage: toy.count, with: {n: 4}}\n"
               "  - stage: toy.sum\n"
               "  - {stage: toy.write, with: {file: ${output}/sum.txt}}\n");
  }
  ~ProgramTest() override { std::filesystem::remove_all(folder_); }

  pid_t start(std::vector<std::string> words) {
    words.insert(words.begin(), CRISP_PROGRAM);
    if (words.size() > 1 && words[1] != "--help" && words[1] != "--version") {
      words.insert(words.end(), {"--plugin", TOY_PLUGIN});
    }
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, 1, (folder_ / "stdout").c_str(), kFlags, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, (folder_ / "stderr").c_str(), kFlags, 0600);
    pid_t child = -1;
    EXPECT_EQ(posix_spawn(&child, CRISP_PROGRAM, &actions, nullptr, arguments.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    return child;
  }

  Outcome wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), content("stdout"),
            content("stderr")};
  }

  Outcome crisp(const std::vector<std::string>& words) { return wait_for(start(words)); }

  /// Until a run in the folder out has begun to write a file.
  void wait_for_part() const {
    const auto is_part = [](const auto& entry) { return entry.path().extension() == ".part"; };
    std::error_code not_yet;
    for (const auto out = folder_ / "out";; std::this_thread::yield()) {
      const std::filesystem::directory_iterator entries(out, not_yet);
      if (std::any_of(begin(entries), end(entries), is_part)) return;
    }
  }

  /// Until the process handles a signal, or has ended.
  static void wait_for_handler(pid_t process, int signal) {
    const auto file = "/proc/" + std::to_string(process) + "/status";
    for (;; std::this_thread::yield()) {
      std::ifstream status(file);
      for (std::string line; std::getline(status, line);) {
        if (line.starts_with("State:") && line.find('Z') != std::string::npos) return;
        if (!line.starts_with("SigCgt:")) continue;
        if ((std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0) return;
      }
    }
  }

  std::string content(const std::string& name) const {
    return files::read_text_file(folder_ / name, 1 << 24);
  }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(content(name)); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
};

}  // namespace crisp
