// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/app/batch_request.hpp"
#include "pipeline/app/commands.hpp"

namespace crisp::app {

/// `crisp cluster submit`.
struct ClusterSubmitRequest {
  BatchRequest batch;
  std::vector<std::string> plugins;  ///< that the tasks load
  std::uint64_t tasks = 0;
  unsigned cpus = 1;                ///< of a task
  std::vector<std::string> sbatch;  ///< further options of sbatch, without dashes: "partition=long"
  bool dry_run = false;             ///< prints what would be submitted
  bool wait = false;                ///< until the merge job has ended, whose exit status this is then
};

/// Submits a batch to Slurm: an array of tasks, each with its part of the recordings, and a job after them
/// that writes the table and has the exit status of the whole batch. Scripts and logs are in
/// OUTPUT/manifest/slurm.
ExitStatus cluster_submit_command(const ClusterSubmitRequest& request, const Registrar& registrar);

}  // namespace crisp::app
