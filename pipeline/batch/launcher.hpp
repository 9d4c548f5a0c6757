// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace crisp::batch {

/// One recording to be processed by a process of its own.
struct Job {
  std::uint64_t id = 0;
  std::string name;              ///< of the recording: its output folder, relative to the batch's
  std::filesystem::path input;   ///< a file, or a folder of captures of one scanner
  std::filesystem::path output;  ///< folder of its results
  std::filesystem::path rig;     ///< empty: the one that the pipeline names
};

/// Result of a job's process.
struct JobEnd {
  std::uint64_t id = 0;
  int exit_status = 0;       ///< of the process, where no signal ended it
  int signal = 0;            ///< that ended it; 0: none
  double seconds = 0;        ///< from its start to its end
  double cpu_seconds = 0;    ///< in user and kernel mode
  std::uint64_t memory = 0;  ///< [bytes] largest resident set
  std::string error;         ///< the end of what it printed to the standard error
};

/// Runs jobs as processes that never outlive this one, however it ends.
///
/// A small process that is forked at once starts them, each by a further fork: a job starts within
/// milliseconds, since everything is loaded already, and its memory is measured without that of the batch.
/// Each job is a process group of its own; what it leaves running is killed.
class JobLauncher {
 public:
  using Run = std::function<int(const Job&)>;

  /// To be called while the process has one thread.
  /// @param run  is called in the job's process; returns its exit status
  /// @throws Error if the system refuses another process
  explicit JobLauncher(const Run& run);
  /// Kills the jobs that still run.
  ~JobLauncher();
  JobLauncher(const JobLauncher&) = delete;
  JobLauncher& operator=(const JobLauncher&) = delete;

  /// @throws Error if the launcher's process is gone
  void start(const Job& job) const;
  /// Sends a signal to a job's processes; nothing happens if it has ended.
  void signal(std::uint64_t id, int signal) const;
  /// The next job that ends within this time; nothing if none does, or a signal interrupts the waiting.
  /// @throws Error if the launcher's process is gone
  std::optional<JobEnd> wait(std::chrono::milliseconds limit) const;

 private:
  void send(const std::string& message) const;

  pid_t process_ = -1;
  int socket_ = -1;
};

}  // namespace crisp::batch
