// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/decimal.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <string>

namespace crisp::table {

namespace {

/// Splits the exponent off a number: "1.5e-3" → "1.5" and -3. Nothing without a valid one.
std::optional<int> take_exponent(std::string_view& text) {
  constexpr int kLargest = 400;  // as a double's, and some more
  const auto e = text.find_first_of("eE");
  if (e == std::string_view::npos) return 0;
  std::string_view digits = text.substr(e + 1);
  text = text.substr(0, e);
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  int value = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_read = failure == std::errc() && end == digits.data() + digits.size() && !digits.empty();
  return is_read && std::abs(value) <= kLargest ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<std::int64_t> shifted_decimal(std::string_view text, int exponent) {
  const bool negative = !text.empty() && text.front() == '-';
  if (negative || (!text.empty() && text.front() == '+')) text.remove_prefix(1);
  const auto own = take_exponent(text);
  if (!own) return std::nullopt;
  const auto point = std::min(text.find('.'), text.size());
  const auto whole = text.substr(0, point);
  const auto fraction = point < text.size() ? text.substr(point + 1) : std::string_view{};
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (whole.empty() && fraction.empty()) return std::nullopt;
  if (!std::all_of(whole.begin(), whole.end(), is_digit)) return std::nullopt;
  if (!std::all_of(fraction.begin(), fraction.end(), is_digit)) return std::nullopt;

  // All digits as a whole number, of which as many count as stand before the moved point.
  std::string digits = "0" + std::string(whole) + std::string(fraction);
  const auto before = static_cast<std::ptrdiff_t>(whole.size()) + 1 + exponent + *own;
  if (before < 0) return 0;
  const auto places = static_cast<std::size_t>(before);
  const bool rounds_up = places < digits.size() && digits[places] >= '5';
  digits.resize(places, '0');
  std::int64_t value = 0;
  if (!digits.empty()) {
    const auto failure = std::from_chars(digits.data(), digits.data() + digits.size(), value).ec;
    if (failure != std::errc() || value > std::numeric_limits<std::int64_t>::max() / 4) return std::nullopt;
  }
  value += rounds_up ? 1 : 0;
  return negative ? -value : value;
}

}  // namespace crisp::table
