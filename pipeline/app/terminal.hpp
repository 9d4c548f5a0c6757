// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace crisp::app {

/// Columns of the terminal that the standard error goes to; 0 if there is none.
std::size_t terminal_width();

/// [s] since any fixed moment; never goes back.
double seconds_now();

}  // namespace crisp::app
