// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <crisp/pipeline.hpp>
#include <crisp/runner.hpp>

#include "pipeline/files/sha256.hpp"

namespace crisp::app {

/// A file that a run read, and what was in it.
struct InputRecord {
  std::filesystem::path file;
  files::FileDigest digest;
};

/// The complete record of a finished run.
struct RunRecord {
  std::string command;  ///< that started the program
  std::filesystem::path pipeline_file;
  std::filesystem::path rig_file;  ///< empty: the default rig
  std::uint64_t seed = 0;
  unsigned threads = 0;
  std::string started;  ///< ISO 8601, UTC
  double seconds = 0;
  std::string failure;                          ///< why it did not come to its end; empty if it did
  int exit_status = 0;                          ///< of the program
  std::vector<nlohmann::ordered_json> options;  ///< the effective ones of each stage
  std::vector<NodeResult> nodes;
  std::vector<InputRecord> inputs;  ///< the pipeline's file, the rig's, and what the stages read; each once

  bool is_trusted() const;  ///< whether it came to its end and no stage had a caveat
  bool wrote_any() const;   ///< whether a stage wrote a file
};

/// Hashes what the run read; to be called when it is over. Devices and folders are left out.
std::vector<InputRecord> hash_inputs(const RunRecord& record);

/// summary.json: everything that is known of the run, each stage with its own section.
nlohmann::ordered_json summary_json(const RunRecord& record);

/// The provenance record of a written file.
nlohmann::ordered_json provenance_json(const RunRecord& record, const std::filesystem::path& file);

/// Has the stages write what shows the whole run: see Context::when_recorded(). What could not be written no
/// longer counts as written. Each is tried.
/// @throws Errors  why some could not be written
void write_when_recorded(RunRecord& record);

/// Writes FILE.provenance.json next to every file that the stages wrote. Each is tried.
/// @throws Errors  why some could not be written
void write_provenance(const RunRecord& record);

/// Writes summary.json into the folder (if it is not empty). The summary of a failed run states the failure;
/// an earlier run's summary is removed in any case.
/// @throws Error  if it cannot be written
void write_summary(const RunRecord& record, const std::filesystem::path& folder);

}  // namespace crisp::app
