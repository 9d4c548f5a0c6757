// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/app/commands.hpp"
#include "pipeline/batch/recording.hpp"

namespace crisp::app {

/// `crisp batch`.
struct BatchRequest {
  RunRequest run;  ///< how each recording is run: the pipeline, --set, --seed, --threads
  std::vector<std::string> inputs;
  std::filesystem::path output;
  std::string each = "file";  ///< or "folder"
  std::filesystem::path base;
  std::string rig;  ///< may hold {folder}, {stem} and {name}; empty: the pipeline's
  unsigned jobs = 1;
  std::string timeout;       ///< "90s"; empty: none
  std::uint64_t memory = 0;  ///< [bytes] for all jobs together; 0: unbounded
  std::string shard;         ///< "3/64"; empty: that of Slurm's array, or all
};

/// The arguments that are needed to run the batch again, for the manifest, and back.
nlohmann::ordered_json arguments_json(const BatchRequest& request);
/// Sets what `arguments_json` gave, but not the output, nor what does not change the results.
void set_arguments(const nlohmann::ordered_json& arguments, BatchRequest& request);

/// The words behind `crisp batch` that give this request, without --jobs and --shard.
std::vector<std::string> batch_words(const BatchRequest& request);

/// The rig file of a recording: {folder}, {stem} and {name} are replaced by the recording's folder, its name
/// without extension, and its name.
std::filesystem::path rig_path(const std::string& pattern, const batch::BatchInput& input);

/// Whether each recording has a rig of its own.
bool has_rig_each(const BatchRequest& request);

}  // namespace crisp::app
