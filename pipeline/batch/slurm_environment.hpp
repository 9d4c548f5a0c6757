// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "pipeline/batch/shard.hpp"

namespace crisp::batch {

/// The value of a variable of the environment, or nullptr.
using EnvironmentVariable = const char* (*)(const char* name);

/// The shard of this task of a Slurm array, by SLURM_ARRAY_TASK_ID, _MIN, _COUNT and _STEP; nothing outside
/// of an array.
/// @throws Error if the array has gaps, so that its tasks cannot be numbered
std::optional<Shard> shard_of_slurm(EnvironmentVariable variable);

/// Number of cores that Slurm allocated to this task, by SLURM_CPUS_ON_NODE; nothing outside of a Slurm job.
std::optional<unsigned> cores_of_slurm(EnvironmentVariable variable);

}  // namespace crisp::batch
