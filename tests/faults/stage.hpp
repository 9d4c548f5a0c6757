// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/faults/emulated_scanner.hpp"
#include "tests/faults/file_state.hpp"
#include "tests/faults/program_run.hpp"
#include "tests/faults/scenario.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp::test {

/// The folders of a scenario: inputs, which must not change, and the output folder as an earlier run left it.
class Stage {
 public:
  /// Makes inputs, the earlier run and the undisturbed one.
  /// @throws std::runtime_error  if one of them fails
  explicit Stage(Scenario scenario);

  /// The calls of an undisturbed run on files below the folders.
  const std::vector<FileCall>& calls() const { return calls_; }
  const Files& inputs() const { return inputs_; }
  const Files& earlier() const { return earlier_; }          ///< output folder before each run
  const Files& undisturbed() const { return undisturbed_; }  ///< and after a run without fault
  int status() const { return status_; }                     ///< of that run
  std::chrono::microseconds lasted() const { return lasted_; }
  const Scenario& scenario() const { return scenario_; }

  /// Puts the output folder back to what it was after the earlier run.
  void reset() const;
  ProgramEnd run(const Fault& fault = {}) const;
  /// The run after one with a fault; of a batch the failed recordings, too.
  ProgramEnd run_next() const;
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
  std::chrono::microseconds lasted_{};
  std::unique_ptr<EmulatedScanner> scanner_;
};

}  // namespace crisp::test
