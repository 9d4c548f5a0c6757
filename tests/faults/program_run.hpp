// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace crisp::test {

/// A call of the program: on a file below the watched folder, or for memory.
struct FileCall {
  long number = 0;  ///< counted from 1
  std::string
      name;  ///< "open", "write", "rename" …; "thread", "new": a thread is started, a large block allocated
  std::filesystem::path file;

  bool needs_memory() const { return name == "thread" || name == "new"; }
};

/// What fault_preload.cpp does at a call, or the death of the program at some moment.
struct Fault {
  long call = 0;     ///< 0: at none
  std::string kind;  ///< number of errno, "full", "starved", "short", "kill" or "torn"
  std::string name;  ///< for people: "ENOSPC"
  std::chrono::microseconds killed_after{};  ///< without a call; 0: never

  bool kills() const { return kind == "kill" || kind == "torn" || killed_after.count() > 0; }
};

struct ProgramEnd {
  int status = -1;                     ///< exit status; -1 if a signal ended the program
  int signal = 0;                      ///< 0 if none did; SIGALRM after a minute
  std::string messages;                ///< what it wrote to standard error
  std::vector<FileCall> calls;         ///< the call with the fault; every call of a run without fault
  std::chrono::microseconds lasted{};  ///< until the program had ended
};

/// Starts `crisp ARGUMENTS`, with its messages in a file.
pid_t start_program(const std::vector<std::string>& arguments, const std::filesystem::path& messages);

/// Runs `crisp ARGUMENTS` with a fault in its calls on files below `folder`, to the end of all processes that
/// it began.
ProgramEnd run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                       const Fault& fault = {});

}  // namespace crisp::test
