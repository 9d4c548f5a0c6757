// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/signals.hpp"

#include <csignal>

namespace crisp {
namespace {

// Signal handlers reach nothing but objects of static storage; lock-free atomics are what they may write.
std::atomic<bool> stop_requested = false;
std::atomic<int> last_signal = 0;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void request_stop(int signal) {
  last_signal = signal;
  stop_requested = true;
}

void handle(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESETHAND | SA_RESTART;  // reset: the second signal has its usual effect
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

}  // namespace

StopOnSignal::StopOnSignal() {
  stop_requested = false;
  last_signal = 0;
  handle(request_stop);
}

StopOnSignal::~StopOnSignal() { handle(SIG_DFL); }

const std::atomic<bool>* StopOnSignal::flag() { return &stop_requested; }

int StopOnSignal::signal() { return last_signal; }

}  // namespace crisp
