// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <crisp/cloud.hpp>

#include "pipeline/app/commands.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp::test {

/// What `crisp run` ended in.
struct Outcome {  // NOLINT(bugprone-exception-escape): moving JSON checks what it holds
  app::ExitStatus status = app::ExitStatus::failed;
  std::string console;                 ///< its output on stderr: errors, warnings, caveats
  nlohmann::json summary;              ///< summary.json; null if there is none
  std::vector<std::string> files;      ///< in the output folder, sorted
  std::shared_ptr<const Cloud> cloud;  ///< cloud.pcd; null if there is none

  /// A stage's entry in the summary.
  const nlohmann::json& stage(const std::string& tag) const;
  /// A count of a stage; 0 if there is none of this name.
  std::uint64_t count(const std::string& tag, const std::string& name) const;
  /// The sum of all counts of a stage.
  std::uint64_t losses(const std::string& tag) const;
};

/// A folder in which the program's own pipelines are run, as `crisp run` does, but within this process.
class PipelineFixture {
 public:
  PipelineFixture();

  /// `crisp run configs/CONFIG -i INPUT -o OUTPUT --quiet --set …`; OUTPUT is a folder in the fixture, which
  /// is emptied before.
  Outcome run(const std::string& config, const std::filesystem::path& input, const std::string& output,
              const std::vector<std::string>& set = {}, const std::filesystem::path& rig = {}) const;

  /// configs/simulate.yaml into the folder `output`; options of grabber.simulate as "duration=1s".
  /// @throws std::runtime_error if that fails: no test is about it
  void simulate(const std::string& output, const std::vector<std::string>& options,
                const std::filesystem::path& rig = {}) const;

  /// configs/assemble.yaml with a simulation's capture and true calibration, or with another capture.
  Outcome assemble(const std::string& simulation, const std::string& output,
                   const std::filesystem::path& capture = {}) const;

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  TemporaryFolder folder_;  ///< in memory where there is such a place: every file is put on the disk for sure
};

}  // namespace crisp::test
