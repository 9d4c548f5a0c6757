// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cctype>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace crisp::files {

/// The JSON as text, in one line or indented by so many spaces a level. Names of files and devices may hold
/// any byte: what is no UTF-8 becomes U+FFFD, where the library alone would throw.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// The text without white space: what the first keys of a file are recognised by, however it is indented.
inline std::string without_space(std::string_view text) {
  std::string packed;
  for (const char c : text) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0) packed += c;
  }
  return packed;
}

}  // namespace crisp::files
