// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/app/batch_request.hpp"
#include "pipeline/app/commands.hpp"
#include "pipeline/batch/plan.hpp"
#include "pipeline/batch/shard.hpp"

namespace crisp::app {

/// A validated batch that is ready to run.
struct PreparedBatch {
  batch::Shard shard;
  std::optional<double> timeout;
  std::size_t total = 0;                      ///< how many recordings there are in all shards
  std::vector<batch::BatchInput> recordings;  ///< of this shard, until they are planned
  nlohmann::ordered_json settings;
  std::string digest;
  batch::BatchPlan plan;

  /// Whether there is nothing to do and nothing to write.
  bool is_over(const std::filesystem::path& output) const;
};

/// The run of a single recording.
RunRequest run_of(const BatchRequest& request, const batch::Job& job);

/// The requested shard, or the one of this task of a Slurm array, or all recordings.
/// @throws Error
batch::Shard shard_of(const BatchRequest& request);

/// Validates the batch before the output folder is touched.
/// @throws Error or Errors
PreparedBatch check_batch(const BatchRequest& request, const batch::Shard& shard, const Registrar& registrar);

/// Finds what is due, and prints why. To be called while no other process has the lock of the task.
void plan_due(const BatchRequest& request, PreparedBatch& batch);

}  // namespace crisp::app
