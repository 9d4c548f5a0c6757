// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/faults/program_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp::test {

/// One way to run the program on a small input.
struct Scenario {
  std::string name;
  std::string pipeline;              ///< file below configs/, or the text of a pipeline
  std::string input;                 ///< file in the folder of inputs; "": none
  std::vector<std::string> set;      ///< for --set
  std::vector<std::string> earlier;  ///< further --set of the earlier run into the same folder
  std::string grows;                 ///< file that is written in place, behind what is there
};

const std::vector<Scenario>& scenarios();

/// The files of a folder by name, with their bytes.
using Files = std::map<std::string, std::string>;
Files files_in(const std::filesystem::path& folder);

/// The folders of a scenario: inputs, which must not change, and the output folder as an earlier run left it.
class Stage {
 public:
  /// Makes inputs, the earlier run and the undisturbed one.
  /// @throws std::runtime_error  if one of them fails
  explicit Stage(const Scenario& scenario);

  /// The calls of an undisturbed run on files below the folders.
  const std::vector<FileCall>& calls() const { return calls_; }
  const Files& inputs() const { return inputs_; }
  const Files& earlier() const { return earlier_; }          ///< output folder before each run
  const Files& undisturbed() const { return undisturbed_; }  ///< and after a run without fault
  int status() const { return status_; }                     ///< of that run
  const Scenario& scenario() const { return scenario_; }

  /// Puts the output folder back to what it was after the earlier run.
  void reset() const;
  ProgramEnd run(const Fault& fault = {}) const;
  std::filesystem::path input() const { return folder_ / "in"; }
  std::filesystem::path output() const { return folder_ / "out"; }

 private:
  std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const;
  void make_inputs() const;

  Scenario scenario_;
  TemporaryFolder folder_;
  std::vector<FileCall> calls_;
  Files inputs_;
  Files earlier_;
  Files undisturbed_;
  int status_ = 0;
};

}  // namespace crisp::test
