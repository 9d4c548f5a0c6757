// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crisp::batch {

/// The scripts share/crisp/slurm/batch.sbatch and merge.sbatch.
extern const std::string_view kSlurmBatchScript;
extern const std::string_view kSlurmMergeScript;

/// The values that complete one of these scripts.
struct SlurmScriptValues {
  std::vector<std::pair<std::string, std::string>> options;  ///< of sbatch, without dashes: "array", "1-64"
  std::string program;                                       ///< crisp's file
  std::vector<std::string> words;                            ///< the script's arguments
};

/// A script with these values in its `#SBATCH` lines, and the program and its arguments in the place of the
/// line that is left for them.
std::string complete_slurm_script(std::string_view script, const SlurmScriptValues& values);

/// A word as bash reads it back.
std::string bash_quoted(std::string_view word);

/// A path as sbatch takes it for a log: there, % begins a number of the job.
std::string slurm_log_path(std::string_view path);

/// The most tasks that an array may have whose first index is 1, by what `scontrol show config` prints.
std::optional<std::uint64_t> longest_slurm_array(std::string_view config);

}  // namespace crisp::batch
