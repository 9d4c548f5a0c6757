// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <iosfwd>
#include <thread>

namespace crisp::app {

/// Once constructed, stops the run at the first SIGINT, SIGTERM or SIGHUP; a second one ends the program at
/// once.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  static const std::atomic<bool>* flag();
  static int signal();  ///< the signal that came, or 0
};

/// While it lives, announces a stop at once: a stage may work for long before it tests for interruption.
class StopNotice {
 public:
  explicit StopNotice(std::ostream& out);

 private:
  std::jthread watch_;
};

}  // namespace crisp::app
