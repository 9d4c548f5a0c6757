// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/signal_cleanup.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <utility>

namespace crisp {
namespace {

// A signal handler reaches nothing but objects of static storage, and may not wait for a lock.
constexpr std::size_t kMaxFiles = 64;  // at once; those beyond stay when a signal ends the program
std::array<std::atomic<const char*>, kMaxFiles> files_to_remove;
static_assert(std::atomic<const char*>::is_always_lock_free);

void replace_once(const char* known, const char* by) {
  for (auto& place : files_to_remove) {
    const char* expected = known;
    if (place.compare_exchange_strong(expected, by)) return;
  }
}

}  // namespace

SignalCleanup::SignalCleanup(std::string file) : file_(std::move(file)) {
  replace_once(nullptr, file_.c_str());
}

SignalCleanup::~SignalCleanup() { replace_once(file_.c_str(), nullptr); }

}  // namespace crisp

namespace crisp::files {

void remove_files_at_signal() noexcept {
  for (const auto& place : files_to_remove) {
    if (const char* file = place.load()) unlink(file);
  }
}

}  // namespace crisp::files
