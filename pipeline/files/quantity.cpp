// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/quantity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "pipeline/data/degree.hpp"

namespace crisp::files {
namespace {

struct Unit {
  std::string_view name;
  std::string_view si;
  double factor;
  double divisor = 1;  ///< powers of ten below 1 are none of a double, which their reciprocals are
};

constexpr double kTurn = 2 * std::numbers::pi;

// Every spelling that is understood, with what one of it is in the SI unit: factor / divisor.
constexpr std::array kUnits = {
    Unit{"m", "m", 1},
    Unit{"um", "m", 1, 1e6},
    Unit{"µm", "m", 1, 1e6},
    Unit{"mm", "m", 1, 1e3},
    Unit{"cm", "m", 1, 1e2},
    Unit{"km", "m", 1e3},
    Unit{"rad", "rad", 1},
    Unit{"mrad", "rad", 1, 1e3},
    Unit{"deg", "rad", data::kDegree},
    Unit{"°", "rad", data::kDegree},
    Unit{"turn", "rad", kTurn},
    Unit{"s", "s", 1},
    Unit{"ns", "s", 1, 1e9},
    Unit{"us", "s", 1, 1e6},
    Unit{"µs", "s", 1, 1e6},
    Unit{"ms", "s", 1, 1e3},
    Unit{"min", "s", 60},
    Unit{"h", "s", 3600},
    Unit{"Hz", "Hz", 1},
    Unit{"kHz", "Hz", 1e3},
    Unit{"rad/s", "rad/s", 1},
    Unit{"deg/s", "rad/s", data::kDegree},
    Unit{"turn/s", "rad/s", kTurn},
    Unit{"rpm", "rad/s", kTurn / 60},
    Unit{"m/s", "m/s", 1},
    Unit{"mm/s", "m/s", 1, 1e3},
    Unit{"km/h", "m/s", 1, 3.6},
    Unit{"%", "1", 1, 1e2},
    Unit{"ppm", "1", 1, 1e6},
};

Complaint complain(std::string_view text, std::string_view why) {
  constexpr std::size_t kLongest = 60;
  return {fmt::format("'{}' {}", text.substr(0, kLongest), why)};
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool has_leading_zero(std::string_view number) {
  if (!number.empty() && number.front() == '-') number.remove_prefix(1);
  return number.size() > 1 && number[0] == '0' && is_digit(number[1]);
}

/// The unit with the micro sign µ of the table in place of the Greek letter μ, which has the same glyph.
std::string with_micro_sign(std::string_view unit) {
  constexpr std::string_view kLetter = "\u03bc";
  return unit.starts_with(kLetter) ? "\u00b5" + std::string(unit.substr(kLetter.size())) : std::string(unit);
}

struct NumberAndRest {
  double number;
  std::string_view rest;
};

/// The decimal number that the text begins with, or nothing.
std::optional<NumberAndRest> leading_decimal(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && text.front() == '-') return std::nullopt;
  }
  const auto first = text.find_first_not_of('-');
  if (first == std::string_view::npos || !(is_digit(text[first]) || text[first] == '.')) return std::nullopt;
  double number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc()) return std::nullopt;
  return NumberAndRest{number, text.substr(static_cast<std::size_t>(end - text.data()))};
}

/// The decimal number or fraction (1/6) that the text begins with, or nothing.
std::optional<NumberAndRest> leading_number(std::string_view text) {
  const auto numerator = leading_decimal(text);
  if (!numerator || numerator->rest.size() < 2 || numerator->rest[0] != '/' || !is_digit(numerator->rest[1]))
    return numerator;
  const auto denominator = leading_decimal(numerator->rest.substr(1));
  if (!denominator || denominator->number == 0) return std::nullopt;
  return NumberAndRest{numerator->number / denominator->number, denominator->rest};
}

Complaint wrong_unit(std::string_view text, std::string_view given, std::string_view requested) {
  if (requested.empty()) return complain(text, "has a unit, but a plain number is expected");
  const auto known =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.name == given; });
  const std::string units = fmt::format("{}", fmt::join(units_of(requested), ", "));
  if (known == kUnits.end()) {
    return complain(text, fmt::format("has the unknown unit '{}'{}{}", given.substr(0, 20),
                                      units.empty() ? "" : "; understood are ", units));
  }
  const std::string dimension =
      requested == "1" ? "a number without dimension" : fmt::format("{}", requested);
  return complain(text, fmt::format("cannot be converted to {}", dimension));
}

}  // namespace

std::variant<double, Complaint> parse_quantity(std::string_view text, std::string_view unit) {
  const std::string_view whole = trimmed(text);
  const auto parts = leading_number(whole);
  if (!parts) return complain(text, "is not a number");
  if (has_leading_zero(whole)) return complain(text, "begins with 0, which is ambiguous");
  if (!std::isfinite(parts->number)) return complain(text, "is not a finite number");
  const std::string_view given = trimmed(parts->rest);
  if (given.empty() || (given == unit && unit != "1")) return parts->number;
  const std::string spelt = with_micro_sign(given);
  for (const auto& known : kUnits) {
    if (known.name != spelt || known.si != unit) continue;
    const double value = parts->number * known.factor / known.divisor;
    if (!std::isfinite(value)) return complain(text, "is not a finite number");
    return value;
  }
  return wrong_unit(text, spelt, unit);
}

std::variant<std::int64_t, Complaint> parse_integer(std::string_view text) {
  const std::string_view whole = trimmed(text);
  if (has_leading_zero(whole)) return complain(text, "begins with 0, which is ambiguous");
  std::int64_t integer = 0;
  const auto [end, failure] = std::from_chars(whole.data(), whole.data() + whole.size(), integer);
  if (failure == std::errc() && end == whole.data() + whole.size()) return integer;
  const auto parts = leading_decimal(whole);   // 1e6, +5
  constexpr double kExact = 9007199254740992;  // 2^53
  const bool is_whole = parts && parts->rest.empty() && std::trunc(parts->number) == parts->number;
  if (!is_whole || std::abs(parts->number) > kExact) return complain(text, "is not a whole number");
  return static_cast<std::int64_t>(parts->number);
}

std::vector<std::string> units_of(std::string_view unit) {
  std::vector<std::string> names;
  for (const auto& known : kUnits) {
    if (known.si == unit) names.emplace_back(known.name);
  }
  return names;
}

}  // namespace crisp::files
