// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace crisp::test {

/// Slurm itself, with three nodes on this machine, n1 to n3, of one core each, while the object lives. Its
/// files are in a folder of the test's, and its ports are free ones: it disturbs no Slurm that runs here. The
/// environment names it to Slurm's programs (SLURM_CONF).
class Slurm {
 public:
  /// What is missing to start it, in words; empty: nothing.
  static std::string missing();

  /// @throws std::runtime_error if no node is idle after a minute
  explicit Slurm(std::filesystem::path folder);
  ~Slurm();
  Slurm(const Slurm&) = delete;
  Slurm& operator=(const Slurm&) = delete;

  /// Kills a node's daemon, and all that it started, as a power failure does.
  void kill_node(const std::string& node);

  /// Waits until a job has ended.
  /// @return its exit status and the signal that ended it: "3:0"
  std::string wait_for_job(const std::string& job) const;

  /// The processes of the nodes' tasks that have a variable of this value in their environment.
  std::vector<pid_t> processes_with(const std::string& variable, const std::string& value) const;

 private:
  void write_configuration();
  pid_t start(std::vector<std::string> words) const;
  void wait_until_idle() const;
  /// Kills the sessions that these processes belong to, the first process of each at first.
  void kill_sessions(const std::vector<pid_t>& processes) const;

  static constexpr std::array kNodes = {"n1", "n2", "n3"};

  std::filesystem::path folder_;
  pid_t munge_ = -1;
  pid_t controller_ = -1;
  std::array<pid_t, kNodes.size()> nodes_{};
};

/// The value of a variable of a process's environment; empty if it has none.
std::string variable_of(pid_t process, const std::string& variable);

}  // namespace crisp::test
