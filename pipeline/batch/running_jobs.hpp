// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <poll.h>
#include <sys/types.h>

#include <chrono>
#include <map>
#include <optional>
#include <vector>

#include "pipeline/batch/launcher.hpp"

namespace crisp::batch {

/// The processes of the jobs that run, as the launcher's process sees them: it starts, signals and reaps
/// them.
class RunningJobs {
 public:
  /// @param run            is called in the job's process
  /// @param close_in_jobs  descriptors of the launcher's that a job must not hold
  RunningJobs(const JobLauncher::Run& run, std::vector<int> close_in_jobs);
  /// Kills all jobs.
  ~RunningJobs();
  RunningJobs(const RunningJobs&) = delete;
  RunningJobs& operator=(const RunningJobs&) = delete;

  /// @return how it ended, if the system refused to start it
  std::optional<JobEnd> start(const Job& job);
  void signal(std::uint64_t id, int signal);
  /// Adds what is to be polled for what the jobs print to their standard error.
  void add_to(std::vector<pollfd>& polled) const;
  /// Reads what the jobs printed.
  void read_errors();
  /// The jobs that ended since the last call.
  std::vector<JobEnd> reap();

 private:
  struct Running {
    std::uint64_t id = 0;
    int error = -1;  ///< read end of its standard error
    std::string printed;
    std::chrono::steady_clock::time_point began;
  };

  [[noreturn]] void become(const Job& job, int error) const;
  static void read_error(Running& job);

  const JobLauncher::Run& run_;
  std::vector<int> close_in_jobs_;
  std::map<pid_t, Running> running_;
};

}  // namespace crisp::batch
