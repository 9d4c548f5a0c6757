// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/signals.hpp"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <ostream>

#include "pipeline/files/signal_cleanup.hpp"

namespace crisp::app {
namespace {

// Signal handlers reach nothing but objects of static storage; lock-free atomics are what they may write.
std::atomic<bool> stop_requested = false;
std::atomic<int> last_signal = 0;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void handle(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESETHAND | SA_RESTART;  // reset: when it is raised anew, it has its usual effect
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    const bool outlives_its_terminal = signal == SIGHUP && before.sa_handler == SIG_IGN;  // nohup
    if (!outlives_its_terminal) sigaction(signal, &action, nullptr);
  }
}

void end_at_once(int signal) {
  files::remove_files_at_signal();
  raise(signal);
}

void request_stop(int signal) {
  handle(end_at_once);
  last_signal = signal;
  stop_requested = true;
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

StopNotice::StopNotice(std::ostream& out)
    : watch_([&out](const std::stop_token& over) {
        constexpr auto kPollEvery = std::chrono::milliseconds(50);
        std::mutex mutex;
        std::condition_variable_any pause;
        std::unique_lock lock(mutex);
        while (!stop_requested && !over.stop_requested()) {
          pause.wait_for(lock, over, kPollEvery, [] { return stop_requested.load(); });
        }
        if (stop_requested) out << "\nstopping; a second signal ends the program at once" << std::endl;
      }) {}

}  // namespace crisp::app
