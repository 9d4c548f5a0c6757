// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/exhaustion.hpp"

#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "pipeline/app/commands.hpp"
#include "pipeline/files/signal_cleanup.hpp"

namespace crisp::app {
namespace {

std::terminate_handler usual = nullptr;

bool is_memory_exhausted() {
  try {
    if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    return true;
  } catch (...) {
    return false;
  }
  return false;
}

/// Gets no memory.
[[noreturn]] void end_program() {
  if (is_memory_exhausted()) {
    constexpr std::string_view kMessage =
        "error: the memory is exhausted; give it less data at once, or end other programs\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
    files::remove_files_at_signal();
    _exit(static_cast<int>(ExitStatus::failed));
  }
  usual();
  std::abort();
}

}  // namespace

void end_where_memory_is_exhausted() { usual = std::set_terminate(end_program); }

}  // namespace crisp::app
