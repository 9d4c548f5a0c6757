// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>

namespace crisp::app {

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace crisp::app
