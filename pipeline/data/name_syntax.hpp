// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string_view>

namespace crisp::data {

/// Whether a name is what YAML, paths and `--set` take as it stands: of a-z, 0-9 and _.
inline bool is_plain_name(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

/// Whether it is plain names with dots between them, or one alone: "links.laser.delay".
inline bool is_dotted_name(std::string_view name) {
  const auto dot = name.find('.');
  if (dot == std::string_view::npos) return is_plain_name(name);
  return is_plain_name(name.substr(0, dot)) && is_dotted_name(name.substr(dot + 1));
}

/// Whether it is a symbol, in which case capitals differ from others: "P".
inline bool is_symbol(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'A' && c <= 'Z') || is_plain_name({&c, 1});
  });
}

/// Whether it is one of a family, "mirror.cone".
inline bool is_name_in_family(std::string_view name) {
  const auto dot = name.find('.');
  return dot != std::string_view::npos && is_plain_name(name.substr(0, dot)) &&
         is_plain_name(name.substr(dot + 1));
}

}  // namespace crisp::data
