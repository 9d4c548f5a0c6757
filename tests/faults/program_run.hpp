// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace crisp::test {

/// A system call of the program on a file below the watched folder.
struct FileCall {
  long number = 0;   ///< counted from 1
  std::string name;  ///< "open", "write", "rename" …
  std::filesystem::path file;
};

/// What fault_preload.cpp does at a call.
struct Fault {
  long call = 0;
  std::string kind;  ///< number of errno, "full", "short", "kill" or "torn"
  std::string name;  ///< for people: "ENOSPC"

  bool kills() const { return kind == "kill" || kind == "torn"; }
};

struct ProgramEnd {
  int status = -1;              ///< exit status; -1 if a signal ended the program
  int signal = 0;               ///< 0 if none did; SIGALRM after a minute
  std::string messages;         ///< what it wrote to standard error
  std::vector<FileCall> calls;  ///< the call with the fault; every call of a run without fault
};

/// Runs `crisp ARGUMENTS` with a fault in its calls on files below `folder`; without `call` there is none.
ProgramEnd run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                       const Fault& fault = {});

}  // namespace crisp::test
