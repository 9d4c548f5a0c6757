// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace crisp {

/// "12 ms", "3.4 s", "2 min 5 s", "1 h 3 min".
std::string format_duration(double seconds);

/// With a prefix where it shortens: "152 MB", "1.2 k points", "7 points".
std::string format_amount(double amount, const std::string& unit);

/// "1 234 567".
std::string format_count(std::uint64_t count);

}  // namespace crisp
