// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/files/yaml.hpp"

namespace crisp::files {

/// Reads a map key by key and collects errors: missing keys, invalid values, and, at the end, unknown keys,
/// with the nearest known one.
class YamlMap {
 public:
  /// @param what  what the map describes, the subject of messages: "laser 'laser1'"
  YamlMap(const YamlNode& node, std::string what, std::vector<Error>& errors);

  /// The value of a key, or nullptr; the key is known from then on.
  const YamlNode* find(const std::string& key);
  /// The same, and an error if it is missing.
  const YamlNode* require(const std::string& key);

  /// Value of a key that may be missing; `fallback` then, and where the value is wrong, which is an error.
  double number(const std::string& key, std::string_view unit, double fallback);
  std::int64_t integer(const std::string& key, std::int64_t fallback, std::int64_t min, std::int64_t max);
  bool boolean(const std::string& key, bool fallback);
  std::string text(const std::string& key, std::string fallback);

  /// Adds an error for each key that was not read.
  void refuse_others();

  void fail(const Place& place, const std::string& what, std::string advice);
  const std::string& what() const { return what_; }

 private:
  const YamlNode& node_;
  std::string what_;
  std::vector<Error>& errors_;
  std::vector<std::string> known_;
};

/// The scalar's meaning, or what is wrong with it. Numbers: see parse_quantity.
std::optional<double> read_number(const YamlNode& node, std::string_view unit, std::string& wrong);
std::optional<std::int64_t> read_integer(const YamlNode& node, std::string& wrong);
std::optional<bool> read_boolean(const YamlNode& node, std::string& wrong);
std::optional<std::string> read_text(const YamlNode& node, std::string& wrong);

/// Value of a key that has one of several names; `fallback` where it is missing, or wrong, which is an error.
/// @param what      "sense of rotation": what a wrong name is not
/// @param expected  "write clockwise or counter_clockwise"
template <class Value>
Value read_choice(YamlMap& map, const std::string& key,
                  std::initializer_list<std::pair<const char*, Value>> choices, Value fallback,
                  const std::string& what, const std::string& expected) {
  const std::string name = map.text(key, "");
  for (const auto& [known, value] : choices) {
    if (name == known) return value;
  }
  if (!name.empty()) map.fail(map.find(key)->place, "'" + key + "': '" + name + "' is no " + what, expected);
  return fallback;
}

/// What an error expects in place of a value: "expected is a number in m".
std::string expected_number(std::string_view unit);

/// Checks `crisp: 1`, the version of the schema, with which all of crisp's files begin.
void check_schema(YamlMap& map, int version);

}  // namespace crisp::files
