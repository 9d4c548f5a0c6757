// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace crisp::app {

/// "12 ms", "3.4 s", "2 min 5 s", "1 h 3 min".
std::string format_duration(double seconds);

/// With a prefix where it shortens: "152 MB", "1.2 k points", "7 points".
std::string format_amount(double amount, const std::string& unit);

/// As much of a text in UTF-8 as fits into so many columns of a terminal; a character takes one.
std::string_view first_columns(std::string_view text, std::size_t columns);

/// "1 234 567".
std::string format_count(std::uint64_t count);

}  // namespace crisp::app
