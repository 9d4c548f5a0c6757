// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <string>

#include "pipeline/app/commands.hpp"
#include "pipeline/batch/table.hpp"

namespace crisp::app {

/// Number of recordings by their status.
struct BatchTally {
  std::size_t done = 0;
  std::size_t untrusted = 0;
  std::size_t failed = 0;     ///< or were killed
  std::size_t open = 0;       ///< are due or run
  std::size_t not_begun = 0;  ///< no task has spoken of them

  void add(const std::map<batch::JobStatus, std::size_t>& kept);
  /// 1: some failed or did not run; 3: some cannot be trusted; 0 otherwise.
  ExitStatus exit_status() const;
};

BatchTally tally_of(const batch::BatchRows& rows);

/// "198 done, 1 untrusted, 1 failed".
std::string in_words(const BatchTally& tally);

/// Why recordings are not done, a line each, the first of many.
std::string trouble_text(const batch::BatchRows& rows);

/// Which recordings stand out in which parameters, a line each, the first of many.
std::string trend_text(const batch::BatchRows& rows);

/// Whether the tables and the report were written after the last event of every manifest.
bool are_tables_current(const std::filesystem::path& output);

/// Reads the manifests and writes table.csv, batch.json, report.html and, where there are calibrations,
/// trend.svg.
/// @param registrar  of the stage that writes the report
/// @param out  where a summary is printed; nullptr: nowhere
/// @throws Error if a file cannot be written; the tables are written before the report
batch::BatchRows write_results(const std::filesystem::path& output, const Registrar& registrar,
                               std::ostream* out);

}  // namespace crisp::app
