// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/output_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace crisp::batch {
namespace {

bool is_utf8(std::string_view text) {
  try {
    static_cast<void>(nlohmann::json(text).dump());
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

}  // namespace

std::string output_name(std::string_view path) {
  const bool utf8 = is_utf8(path);
  if (utf8 && std::ranges::none_of(path, is_control)) return std::string(path);
  std::string name;
  for (const char c : path) {
    const bool plain = !is_control(c) && c != '%' && (utf8 || static_cast<unsigned char>(c) < 0x80);
    name += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return name;
}

bool is_reserved_output(std::string_view name) {
  constexpr std::array kReserved = {kBatchManifest, kBatchSummary, kBatchTable, kBatchTrend, kBatchReport};
  return std::ranges::find(kReserved, name.substr(0, name.find('/'))) != kReserved.end();
}

}  // namespace crisp::batch
