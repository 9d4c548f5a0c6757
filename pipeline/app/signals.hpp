// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <iosfwd>
#include <thread>

namespace crisp {

/// From its making on, the first SIGINT, SIGTERM or SIGHUP asks the run to stop; a second one ends the
/// program at once.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  static const std::atomic<bool>* flag();
  static int signal();  ///< the signal that came, or 0
};

/// While it lives, says at once that the run is about to stop: a stage may be long at work before it asks.
class StopNotice {
 public:
  explicit StopNotice(std::ostream& out);

 private:
  std::jthread watch_;
};

}  // namespace crisp
