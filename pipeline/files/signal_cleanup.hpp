// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace crisp {

/// Names a file that remove_files_at_signal() removes while this object lives.
class SignalCleanup {
 public:
  explicit SignalCleanup(std::string file);
  ~SignalCleanup();
  SignalCleanup(const SignalCleanup&) = delete;
  SignalCleanup& operator=(const SignalCleanup&) = delete;

 private:
  std::string file_;
};

}  // namespace crisp

namespace crisp::files {

/// For a signal handler, before the program ends at once.
void remove_files_at_signal() noexcept;

}  // namespace crisp::files
