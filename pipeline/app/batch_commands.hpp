// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "pipeline/app/batch_request.hpp"
#include "pipeline/app/commands.hpp"

namespace crisp::app {

/// Runs a pipeline over many recordings, each in a process of its own. Recordings that are done and unchanged
/// are skipped. Writes the table to the output folder, a summary to stdout, progress and failures to stderr.
ExitStatus batch_command(const BatchRequest& request, const Registrar& registrar);

/// `crisp batch status`.
struct BatchStatusRequest {
  std::filesystem::path folder;
  bool watch = false;
  bool json = false;
};
/// Prints how many recordings are done, running or failed, and why they failed.
ExitStatus batch_status_command(const BatchStatusRequest& request);

/// `crisp batch table`.
struct BatchTableRequest {
  std::filesystem::path folder;
  bool json = false;
};
/// Writes table.csv, batch.json, report.html and trend.svg from the manifests, and prints the table. The exit
/// status is the one of a batch with these results.
ExitStatus batch_table_command(const BatchTableRequest& request, const Registrar& registrar);

/// `crisp batch retry`.
struct BatchRetryRequest {
  std::filesystem::path folder;
  std::string match = "*";  ///< names of the recordings, a pattern as of a shell
  bool mark = false;        ///< leaves them to the next batch
};
/// Makes failed recordings due again, and reruns the batch.
/// @param request  number of jobs and further limits, which may differ from the last run
ExitStatus batch_retry_command(const BatchRetryRequest& retry, BatchRequest request,
                               const Registrar& registrar);

}  // namespace crisp::app
