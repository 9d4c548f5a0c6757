// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace crisp::test {

/// From now on the system calls of these numbers raise SIGSYS in this process and in those that it makes,
/// where the code of this process's C library makes them. A program that is executed then has its library
/// elsewhere, and runs untouched. Ends the process where that cannot be had.
void trap_calls_of_c_library(std::span<const int> numbers);

}  // namespace crisp::test
