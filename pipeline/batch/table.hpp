// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/batch/manifest.hpp"

namespace crisp::batch {

/// A parameter as a recording's calibration found it, in SI.
struct RowParameter {
  double value = 0;
  std::optional<double> std_error = {};  ///< absent: it was not estimated
  std::string unit = {};
};

/// A recording's row in the table.
struct BatchRow {
  std::string name;
  std::string status;                ///< "done", "untrusted", "failed", "interrupted", "running" or "due"
  std::vector<std::string> reasons;  ///< why it cannot be trusted, failed or is due
  std::string ended;                 ///< ISO 8601, UTC
  double seconds = 0;
  double cpu_seconds = 0;
  std::uint64_t memory = 0;  ///< [bytes]
  std::uint64_t input_bytes = 0;
  std::optional<double> begin = {};  ///< [s since the Unix epoch] of the recording
  std::optional<std::uint64_t> points = {};
  std::map<std::string, double> quality = {};
  std::map<std::string, RowParameter> parameters = {};
  std::vector<std::string> causes = {};      ///< "mirror.cone of laser3"
  std::vector<std::string> stands_out = {};  ///< parameters, see batch_trend()
};

/// The rows of a batch.
struct BatchRows {
  std::vector<BatchRow> rows;  ///< by name
  std::string settings = {};   ///< digest of those of the batch that began last
  nlohmann::ordered_json batch = nlohmann::ordered_json::object();  ///< the event of that batch
  std::size_t recordings = 0;     ///< how many that batch has, all shards together
  std::size_t damaged_lines = 0;  ///< of the manifests, which were passed over

  std::size_t count(std::string_view status) const;
};

/// Reads all manifests of an output folder.
/// @throws Error if there is none, or one cannot be read
BatchRows read_rows(const std::filesystem::path& output);

/// Receives a text piece by piece: the text of a million rows is never in memory as a whole.
using TextSink = std::function<void(std::string_view piece)>;

/// Prints CSV: a line of names, then a line a recording; parameters in SI, each with its standard error in a
/// column of its own. Unknown values are empty.
void print_csv(const BatchRows& rows, const TextSink& sink);

/// The head of the table's JSON: the batch, and the number of recordings by status.
nlohmann::ordered_json head_json(const BatchRows& rows);

/// As JSON: this head, with the rows as its last key, a line a recording.
void print_json(const BatchRows& rows, const nlohmann::ordered_json& head, const TextSink& sink);

}  // namespace crisp::batch
