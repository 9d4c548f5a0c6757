// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/format.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace crisp::app {

std::string format_duration(double seconds) {
  if (!(seconds >= 0)) return "?";
  if (seconds < 0.9995) return fmt::format("{:.0f} ms", seconds * 1e3);
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::int64_t>(std::llround(std::fmin(seconds, 1e12)));
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string format_amount(double amount, const std::string& unit) {
  constexpr std::array kPrefixes = {"", "k", "M", "G", "T"};
  std::size_t prefix = 0;
  while (std::abs(amount) >= 999.5 && prefix + 1 < kPrefixes.size()) {
    amount /= 1000;
    ++prefix;
  }
  const int digits = prefix == 0 || amount >= 9.95 ? 0 : 1;
  const bool word = unit.size() > 1 && *kPrefixes[prefix] != '\0';  // "1.2 k points", but "1.2 kB"
  return fmt::format("{:.{}f} {}{}{}", amount, digits, kPrefixes[prefix], word ? " " : "", unit);
}

std::string_view first_columns(std::string_view text, std::size_t columns) {
  const auto goes_on = [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; };
  std::size_t end = 0;
  for (; columns > 0 && end < text.size(); --columns) {
    ++end;
    while (end < text.size() && goes_on(text[end])) ++end;
  }
  return text.substr(0, end);
}

std::string format_count(std::uint64_t count) {
  std::string text = fmt::format("{}", count);
  for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3) {
    text.insert(static_cast<std::size_t>(at), " ");
  }
  return text;
}

}  // namespace crisp::app
