// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <crisp/error.hpp>

namespace crisp {

/// Type of one value of an option.
enum class OptionType { boolean, integer, number, text, choice, path, groups };

using OptionScalar = std::variant<bool, std::int64_t, double, std::string>;

/// One entry of a map of maps: `mirror.cone: {kappa: 0.3deg}`. The option's owner validates names and units,
/// with the place of each.
struct OptionGroup {
  /// One key of a group, with its value.
  struct Entry {
    std::string name;   ///< "kappa"
    std::string value;  ///< as the user wrote it: "0.3deg"
    Place place;        ///< of the value
  };
  std::string name;            ///< "mirror.cone"
  std::vector<Entry> entries;  ///< in the order of the file
  Place place;                 ///< of the group's name
};
using OptionGroups = std::vector<OptionGroup>;

/// A value of an option: `auto` (monostate), one value, a list of them, or a map of maps. Numbers are in the
/// option's unit.
using OptionValue = std::variant<std::monostate, OptionScalar, std::vector<OptionScalar>, OptionGroups>;

/// In Option::writes: the file that the path names.
inline constexpr const char* kFileItself = "<stem><ext>";

/// One option as it was declared: everything that parsing, validation and documentation need to know.
struct Option {
  std::string name;                    ///< of a-z, 0-9 and _; in a group led by its name, "motion.kind"
  std::string help;                    ///< in half a sentence
  OptionType type = OptionType::text;  ///< of one value
  bool list = false;                   ///< takes a list of values (a single one is a list of length 1)
  bool may_be_auto = false;            ///< `auto` is a value
  bool required = false;               ///< there is no default
  bool is_folder = false;              ///< of a path: the stage writes files into that folder
  std::vector<std::string> writes;     ///< of a path that is written, not read: the files, see NamePattern
  std::string ending;                  ///< of a path: how it must end, ".pcd"; empty: as it likes
  std::string unit;  ///< SI unit of the value ("m", "rad", "s", "Hz", "1"), empty if it has none
  double min = -std::numeric_limits<double>::infinity();            ///< smallest number, in `unit`
  double max = std::numeric_limits<double>::infinity();             ///< largest number, in `unit`
  std::size_t min_count = 0;                                        ///< shortest list
  std::size_t max_count = std::numeric_limits<std::size_t>::max();  ///< longest list
  std::vector<std::string> choices;  ///< all the texts that are allowed, if not empty

  std::function<void(void* object, const OptionValue& value)> set;  ///< writes a valid value into the stage
  std::function<OptionValue(const void* object)> get;               ///< reads the value from the stage
};

/// The error of `value` for this option, in words, or nothing if it is valid.
std::optional<std::string> complaint(const Option& option, const OptionValue& value);

/// Likewise with one value, of a list that the option is, or the option's own.
std::optional<std::string> complaint_of_one(const Option& option, const OptionScalar& scalar);

/// "a length in m, 0.0001 to 10": what the option expects, for messages and documentation.
std::string expectation(const Option& option);

/// The value as a person would write it in YAML, with its unit: "0.05m", "[0.5m, 0.01m]", "auto".
std::string to_text(const Option& option, const OptionValue& value);

}  // namespace crisp
