// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace crisp::files {

/// The fault of a text that is no valid value.
struct Complaint {
  std::string text;
};

/// Reads a number with or without a unit: "5cm", "0.3 deg", "-1.5e-3", "1/6deg". A number without a unit is
/// in `unit`; with one, it is converted to `unit`.
///
/// Refused: units of another dimension or not known, a unit on a number that has none (`unit` empty), leading
/// zeros ("010" is 8 to some readers and 10 to others), inf, nan, hexadecimal, anything behind the number.
/// @param unit  "m", "rad", "s", "Hz", "rad/s", "m/s", "1" (%, ppm), or any other, which then must be spelt
/// the
///              same; empty for a plain number
std::variant<double, Complaint> parse_quantity(std::string_view text, std::string_view unit);

/// Reads a whole number: "12", "-3", also "1e6". The same refusals.
std::variant<std::int64_t, Complaint> parse_integer(std::string_view text);

/// The units that are converted to this one: {"mm", "cm", …} for "m". Empty if none are.
std::vector<std::string> units_of(std::string_view unit);

}  // namespace crisp::files
