// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/control_characters.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace crisp::files {
namespace {

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7f;
}

}  // namespace

std::size_t find_control_character(std::string_view text) {
  const auto* const found = std::ranges::find_if(text, is_control);
  return found == text.end() ? std::string_view::npos : static_cast<std::size_t>(found - text.begin());
}

std::string control_character_in_words(char character) {
  return fmt::format("there is a control character (0x{:02x})", static_cast<unsigned char>(character));
}

std::string shown(std::string_view text) {
  constexpr std::size_t kEnough = 40;
  std::string to;
  for (const char c : text.substr(0, kEnough)) {
    if (c >= ' ' && c <= '~')
      to += c;
    else
      to += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
  return text.size() > kEnough ? to + "…" : to;
}

}  // namespace crisp::files
