// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/yaml_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "pipeline/files/nearest.hpp"
#include "pipeline/files/quantity.hpp"

namespace crisp::files {
namespace {

template <class T>
std::optional<T> unpack(const std::variant<T, Complaint>& result, std::string& wrong) {
  if (const auto* value = std::get_if<T>(&result)) return *value;
  wrong = std::get<Complaint>(result).text;
  return std::nullopt;
}

bool is_scalar(const YamlNode& node, std::string_view requested, std::string& wrong) {
  if (node.kind == YamlNode::Kind::scalar) return true;
  wrong = fmt::format("{} is not {}", describe(node), requested);
  return false;
}

}  // namespace

std::string expected_number(std::string_view unit) {
  if (unit.empty()) return "give a number without a unit";
  return unit == "1" ? "expected is a number" : fmt::format("expected is a number in {}", unit);
}

std::optional<double> read_number(const YamlNode& node, std::string_view unit, std::string& wrong) {
  if (!is_scalar(node, "a number", wrong)) return std::nullopt;
  return unpack(parse_quantity(node.text, unit), wrong);
}

std::optional<std::int64_t> read_integer(const YamlNode& node, std::string& wrong) {
  if (!is_scalar(node, "a whole number", wrong)) return std::nullopt;
  return unpack(parse_integer(node.text), wrong);
}

std::optional<bool> read_boolean(const YamlNode& node, std::string& wrong) {
  if (!is_scalar(node, "true or false", wrong)) return std::nullopt;
  if (node.text == "true") return true;
  if (node.text == "false") return false;
  wrong = describe(node) + " is neither true nor false";
  return std::nullopt;
}

std::optional<std::string> read_text(const YamlNode& node, std::string& wrong) {
  if (!is_scalar(node, "a text", wrong)) return std::nullopt;
  return node.text;
}

YamlMap::YamlMap(const YamlNode& node, std::string what, std::vector<Error>& errors)
    : node_(node), what_(std::move(what)), errors_(errors) {
  if (node.kind != YamlNode::Kind::map)
    fail(node.place, describe(node) + " is not a map", "write lines of KEY: VALUE");
}

void YamlMap::fail(const Place& place, const std::string& what, std::string advice) {
  errors_.emplace_back(what_ + ": " + what, std::move(advice), place);
}

const YamlNode* YamlMap::find(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  return node_.find(key);
}

const YamlNode* YamlMap::require(const std::string& key) {
  const YamlNode* value = find(key);
  if (!value && node_.kind == YamlNode::Kind::map)
    fail(node_.place, "'" + key + "' is missing", "add " + key + ": VALUE");
  return value;
}

double YamlMap::number(const std::string& key, std::string_view unit, double fallback) {
  const YamlNode* value = find(key);
  if (!value) return fallback;
  std::string wrong;
  const auto number = read_number(*value, unit, wrong);
  if (!number) fail(value->place, "'" + key + "': " + wrong, expected_number(unit));
  return number.value_or(fallback);
}

std::int64_t YamlMap::integer(const std::string& key, std::int64_t fallback, std::int64_t min,
                              std::int64_t max) {
  const YamlNode* value = find(key);
  if (!value) return fallback;
  std::string wrong;
  const auto integer = read_integer(*value, wrong);
  if (integer && (*integer < min || *integer > max)) {
    wrong = fmt::format("{} is not from {} to {}", *integer, min, max);
  }
  if (!wrong.empty()) {
    fail(value->place, "'" + key + "': " + wrong,
         fmt::format("expected is a whole number from {} to {}", min, max));
  }
  return wrong.empty() ? *integer : fallback;
}

bool YamlMap::boolean(const std::string& key, bool fallback) {
  const YamlNode* value = find(key);
  if (!value) return fallback;
  std::string wrong;
  const auto boolean = read_boolean(*value, wrong);
  if (!boolean) fail(value->place, "'" + key + "': " + wrong, "expected is true or false");
  return boolean.value_or(fallback);
}

std::string YamlMap::text(const std::string& key, std::string fallback) {
  const YamlNode* value = find(key);
  if (!value) return fallback;
  std::string wrong;
  const auto text = read_text(*value, wrong);
  if (!text) fail(value->place, "'" + key + "': " + wrong, "expected is a text");
  return text.value_or(std::move(fallback));
}

void YamlMap::refuse_others() {
  for (const auto& entry : node_.entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    fail(entry.place, "there is no key '" + entry.key + "'",
         did_you_mean(entry.key, known_, fmt::format("known are {}", fmt::join(known_, ", "))));
  }
}

void check_schema(YamlMap& map, int version) {
  const YamlNode* node = map.require("crisp");
  if (!node) return;
  std::string wrong;
  const auto given = read_integer(*node, wrong);
  if (!given || *given < 1) {
    map.fail(node->place, "'crisp' is to be the version of the schema, a whole number",
             fmt::format("write crisp: {}", version));
  } else if (*given > version) {
    map.fail(
        node->place,
        fmt::format("it has schema version {}, and this program reads up to version {}", *given, version),
        "use a newer crisp");
  }
}

}  // namespace crisp::files
