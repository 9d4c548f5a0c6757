// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/batch/launcher.hpp"
#include "pipeline/batch/manifest.hpp"
#include "pipeline/batch/recording.hpp"

namespace crisp::batch {

/// A recording that is to be processed.
struct DueRecording {
  BatchInput input;
  std::filesystem::path rig;  ///< of this recording alone; empty: there is none
};

/// Limits of a batch's jobs.
struct BatchLimits {
  unsigned jobs = 1;                         ///< at once
  std::optional<double> timeout = {};        ///< [s] after which a job is ended
  std::optional<std::uint64_t> memory = {};  ///< [bytes] for all jobs together
};

/// Progress of a batch.
struct BatchProgress {
  std::size_t total = 0;      ///< recordings that were due
  std::size_t done = 0;       ///< of them, trusted …
  std::size_t untrusted = 0;  ///< … came to their end, but cannot be trusted …
  std::size_t failed = 0;     ///< … failed, or were killed from outside
  std::size_t running = 0;

  std::size_t ended() const { return done + untrusted + failed; }
};

/// Hooks to stop and watch a batch.
struct BatchHooks {
  const std::atomic<bool>* stop = nullptr;
  std::function<bool()> is_lost = {};  ///< whether another process has taken over what this one writes
  std::function<void(const BatchProgress& progress)> progress =
      {};                                                 ///< called at least every tenth of a second
  std::function<void(const std::string& line)> log = {};  ///< what a person should know at once
};

/// Result of a batch.
struct BatchOutcome {
  BatchProgress progress;
  std::string full_disk;  ///< the message that the disk is full, which ended the batch; empty: it is not
};

/// Processes the recordings, several at once, and writes an event for each beginning and end.
/// @param output    folder of the batch
/// @param settings  digest of what they are processed with
/// @throws Error if the launcher's process or the manifest is lost
BatchOutcome run_batch(const std::vector<DueRecording>& due, const std::filesystem::path& output,
                       const std::string& settings, const BatchLimits& limits, JobLauncher& launcher,
                       ManifestWriter& manifest, const BatchHooks& hooks);

}  // namespace crisp::batch
