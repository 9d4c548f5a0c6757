// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>
#include <crisp/pipeline.hpp>

namespace crisp::stage {

/// The record of the whole run, in the output folder.
inline constexpr const char* kSummary = "summary.json";

/// Files that a run itself reads and writes, besides its stages. Empty paths are skipped.
struct FilesOfRun {
  std::vector<std::filesystem::path> read;  ///< the pipeline's own file, the rig's and the input
  std::filesystem::path summary;
  std::vector<std::string> read_in_folders;  ///< endings of the files that are read where a folder is given
};

/// Adds an error for each stage that could write a file that another one reads or writes, by the options of
/// paths, provenance records included; and for each stage that would write a file where a folder is. Opens no
/// file.
void check_files_written(const Pipeline& pipeline, const FilesOfRun& run, std::vector<Error>& errors);

}  // namespace crisp::stage
