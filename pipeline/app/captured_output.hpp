// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace crisp::app {

/// Another program's standard output and exit status.
struct CapturedOutput {
  int status = 0;  ///< 128 and the signal's number if a signal ended it
  std::string text;
};

/// Runs a program of the search path, and waits for its end. Its standard error is this process's.
/// @throws Error if there is no such program
CapturedOutput capture_output(std::vector<std::string> words);

}  // namespace crisp::app
