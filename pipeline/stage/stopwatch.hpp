// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace crisp::stage {

/// Measures each stage's own time: a stage's clock stands while the stages that it feeds are at work.
class Stopwatch {
 public:
  using Clock = std::chrono::steady_clock;

  class Turn {
   public:
    Turn(Stopwatch& watch, double& seconds) : watch_(watch), before_(watch.running_) {
      watch_.switch_to(&seconds);
    }
    ~Turn() { watch_.switch_to(before_); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    Stopwatch& watch_;
    double* before_;
  };

 private:
  void switch_to(double* seconds) {
    const auto now = Clock::now();
    if (running_) *running_ += std::chrono::duration<double>(now - since_).count();
    running_ = seconds;
    since_ = now;
  }

  double* running_ = nullptr;
  Clock::time_point since_;
};

}  // namespace crisp::stage
