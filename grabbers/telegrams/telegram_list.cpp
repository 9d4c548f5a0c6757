// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/telegrams/telegram_list.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

/// Where the n-th byte is.
Place place_of(const std::string& text, std::size_t byte, const std::string& name) {
  const std::string_view before = std::string_view(text).substr(0, std::min(byte, text.size()));
  const auto lines = std::ranges::count(before, '\n');
  const auto column = before.size() - (before.rfind('\n') + 1);  // npos + 1 is 0
  return {name, static_cast<int>(lines) + 1, static_cast<int>(column) + 1};
}

nlohmann::json parsed(const std::string& text, const std::string& name) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    const auto* where = dynamic_cast<const nlohmann::json::parse_error*>(&error);
    const std::size_t byte = where != nullptr && where->byte > 0 ? where->byte - 1 : 0;
    throw Error("this is no JSON", "is it a list of telegrams, and whole?", place_of(text, byte, name));
  }
}

/// The element at the end of a path of keys, or nullptr.
const nlohmann::json* at(const nlohmann::json& from, std::initializer_list<const char*> path) {
  const nlohmann::json* here = &from;
  for (const char* key : path) {
    if (!here->is_object()) return nullptr;
    const auto next = here->find(key);
    if (next == here->end()) return nullptr;
    here = &*next;
  }
  return here;
}

/// "02:1f:…"; nothing if it is not of this form.
std::optional<Bytes> bytes_of(std::string_view text) {
  constexpr std::size_t kDigits = 2;
  Bytes bytes;
  bytes.reserve(text.size() / (kDigits + 1) + 1);
  while (!text.empty()) {
    std::uint8_t byte = 0;
    const char* end = text.data() + std::min(kDigits, text.size());
    constexpr int kHexadecimal = 16;
    const auto read = std::from_chars(text.data(), end, byte, kHexadecimal);
    if (read.ptr != text.data() + kDigits) return std::nullopt;
    bytes.push_back(byte);
    text.remove_prefix(kDigits);
    if (text.empty()) break;
    if (text.front() != ':') return std::nullopt;
    text.remove_prefix(1);
  }
  return bytes;
}

/// A number, or a text that is one [s].
std::optional<std::int64_t> nanoseconds(const nlohmann::json& time) {
  double seconds = -1;
  if (time.is_number()) {
    seconds = time.get<double>();
  } else if (const auto* text = time.get_ptr<const std::string*>()) {
    const auto read = std::from_chars(text->data(), text->data() + text->size(), seconds);
    if (read.ec != std::errc() || read.ptr != text->data() + text->size()) return std::nullopt;
  }
  constexpr double kLongest = 1e9;  // [s] 30 years
  if (!(seconds >= 0 && seconds <= kLongest)) return std::nullopt;
  return std::llround(1e9 * seconds);
}

}  // namespace

std::vector<ListedTelegram> read_telegram_list(const std::string& text, const std::string& name,
                                               Counts& losses) {
  const nlohmann::json list = parsed(text, name);
  if (!list.is_array()) throw Error("this is no list of telegrams", "give a JSON array", Place{name, 1, 1});
  std::vector<ListedTelegram> telegrams;
  for (const nlohmann::json& entry : list) {
    const auto* payload = at(entry, {"_source", "layers", "tcp", "tcp.payload"});
    const auto* time = at(entry, {"_source", "layers", "tcp", "Timestamps", "tcp.time_relative"});
    if (payload == nullptr || !payload->is_string()) {
      losses.add("entries without a payload");
      continue;
    }
    auto bytes = bytes_of(payload->get_ref<const std::string&>());
    const auto time_ns = time != nullptr ? nanoseconds(*time) : std::nullopt;
    if (!bytes) {
      losses.add("entries whose payload is not hexadecimal");
    } else if (!time_ns) {
      losses.add("entries without a time");
    } else {
      telegrams.push_back({*time_ns, std::move(*bytes)});
    }
  }
  return telegrams;
}

}  // namespace crisp
