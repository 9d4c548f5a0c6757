// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace crisp::batch {

/// Results in a job's output folder, for the table.
struct JobResults {
  /// Known results: `error`, `reasons` (why the result is untrusted), `begin` (of the recording, [s since the
  /// Unix epoch]), `points`, `quality` by name, `parameters` by name, each with `value`, `std_error` and
  /// `unit`, and `causes`, the accepted ones.
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  std::map<std::string, std::string> sha256;  ///< of the content of the files that it read, by path
};

/// Reads summary.json, and the calibration and the diagnosis that it names. What cannot be read is named in
/// `reasons`.
JobResults read_results(const std::filesystem::path& output);

/// Removes the summary of an earlier job, which must not be taken for that of the next.
void remove_summary(const std::filesystem::path& output);

}  // namespace crisp::batch
