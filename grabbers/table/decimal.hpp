// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace crisp::table {

/// A decimal number (12, -0.5, +1.5e9) times ten to the `exponent` (0 to 9), rounded to a whole number,
/// exactly: a double would round a time since 1970 to a quarter of a microsecond. Nothing for what is no
/// decimal number or does not fit.
std::optional<std::int64_t> shifted_decimal(std::string_view text, int exponent);

}  // namespace crisp::table
