// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <crisp/error.hpp>

#include "pipeline/batch/job_results.hpp"
#include "pipeline/batch/launcher.hpp"
#include "pipeline/batch/manifest.hpp"
#include "pipeline/batch/run_batch.hpp"

namespace crisp::batch {

/// The outcome of an ended job, as the manifest records it.
// NOLINTNEXTLINE(bugprone-exception-escape): moving JSON checks what it holds
struct JobVerdict {
  JobStatus status = JobStatus::done;
  std::string failure = {};                                         ///< in words; empty: it did not fail
  std::string full_disk = {};                                       ///< that message, where it is the reason
  nlohmann::ordered_json event = nlohmann::ordered_json::object();  ///< the rest of the event `end`
};

/// Why a job may have ended, besides its own reasons.
struct JobCircumstances {
  std::optional<double> timeout = {};  ///< [s] that it exceeded, for which it was ended
  bool stopping = false;               ///< whether all jobs are being stopped
};

/// @param files   of the input, as they were when the job began
/// @param output  folder of the job's results
JobVerdict judge_job(const JobEnd& end, const JobCircumstances& circumstances, const DueRecording& recording,
                     const std::vector<InputFile>& files, const std::filesystem::path& output);

/// Verdict for a recording whose input is missing or unreadable.
JobVerdict refused_input(const Error& error);

/// Whether a message reports that a file could not be written for lack of disk space.
bool is_disk_full_error(std::string_view message);

}  // namespace crisp::batch
