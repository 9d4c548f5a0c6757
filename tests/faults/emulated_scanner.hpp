// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace crisp::test {

/// A laser and a plate on this machine's network while this object lives: `crisp emulate`.
class EmulatedScanner {
 public:
  /// @param rig  file that describes it, which is written
  /// @throws std::runtime_error  if it does not come up
  explicit EmulatedScanner(const std::filesystem::path& rig);
  ~EmulatedScanner();
  EmulatedScanner(const EmulatedScanner&) = delete;
  EmulatedScanner& operator=(const EmulatedScanner&) = delete;

 private:
  TemporaryFolder own_;
  pid_t process_ = -1;
};

}  // namespace crisp::test
