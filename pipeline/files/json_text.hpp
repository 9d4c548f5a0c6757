// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace crisp {

/// The JSON as text, in one line or indented by so many spaces a level. Names of files and devices may hold
/// any byte: what is no UTF-8 becomes U+FFFD, where the library alone would throw.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace crisp
