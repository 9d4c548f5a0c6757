// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/decimal.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string>

namespace crisp {

std::optional<std::int64_t> shifted_decimal(std::string_view text, int exponent) {
  const bool negative = !text.empty() && text.front() == '-';
  if (negative || (!text.empty() && text.front() == '+')) text.remove_prefix(1);
  const auto point = std::min(text.find('.'), text.size());
  const auto whole = text.substr(0, point);
  const auto fraction = point < text.size() ? text.substr(point + 1) : std::string_view{};
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (whole.empty() && fraction.empty()) return std::nullopt;
  if (!std::all_of(whole.begin(), whole.end(), is_digit)) return std::nullopt;
  if (!std::all_of(fraction.begin(), fraction.end(), is_digit)) return std::nullopt;

  const auto places = static_cast<std::size_t>(exponent);
  std::string digits = "0" + std::string(whole) + std::string(fraction.substr(0, places));
  digits.append(places - std::min(places, fraction.size()), '0');
  std::int64_t value = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (failure != std::errc() || value > std::numeric_limits<std::int64_t>::max() / 4) return std::nullopt;
  constexpr char kHalf = '5';
  if (fraction.size() > places && fraction[places] >= kHalf) ++value;
  return negative ? -value : value;
}

}  // namespace crisp
