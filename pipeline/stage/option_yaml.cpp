// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/option_yaml.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "pipeline/files/nearest.hpp"
#include "pipeline/files/quantity.hpp"
#include "pipeline/files/yaml_map.hpp"

namespace crisp::stage {
namespace {

using files::YamlNode;

template <class T>
std::optional<OptionScalar> boxed(const std::optional<T>& value) {
  if (!value) return std::nullopt;
  return OptionScalar(*value);
}

std::optional<OptionScalar> read_scalar(const Option& option, const YamlNode& node,
                                        const std::filesystem::path& folder, std::string& wrong) {
  switch (option.type) {
    case OptionType::boolean:
      return boxed(files::read_boolean(node, wrong));
    case OptionType::integer:
      return boxed(files::read_integer(node, wrong));
    case OptionType::number:
      return boxed(files::read_number(node, option.unit == "1" ? "1" : option.unit, wrong));
    case OptionType::text:
    case OptionType::choice:
      return boxed(files::read_text(node, wrong));
    case OptionType::path:
    case OptionType::groups:  // is no scalar: see Reader
      break;
  }
  const auto path = files::read_text(node, wrong);
  if (path && path->empty()) wrong = "the path is empty";
  if (!wrong.empty()) return std::nullopt;
  return OptionScalar(files::path_of(node, folder).string());
}

/// An option and a value of it, for people: in the unit in which the value was written.
struct AsWritten {
  Option option;
  OptionScalar value;
};

AsWritten as_written(const Option& option, const OptionScalar& value, const std::string& text) {
  AsWritten written{option, value};
  if (!std::holds_alternative<double>(value)) return written;
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const auto unit = text.find_first_not_of(' ', static_cast<std::size_t>(end - text.c_str()));
  if (unit == std::string::npos) return written;
  const auto one = files::parse_quantity("1" + text.substr(unit), option.unit);
  const auto* size = std::get_if<double>(&one);
  if (size == nullptr) return written;
  written.option.unit = text.substr(unit);
  written.option.min /= *size;
  written.option.max /= *size;
  written.value = number;
  return written;
}

class Reader {
 public:
  Reader(const Option& option, const std::string& who, const std::filesystem::path& folder,
         std::vector<Error>& errors)
      : option_(option), who_(who), folder_(folder), errors_(errors) {}

  std::optional<OptionValue> read(const YamlNode& node) {
    if (option_.may_be_auto && node.kind == YamlNode::Kind::scalar && node.text == "auto") {
      return std::monostate{};
    }
    if (option_.type == OptionType::groups) return read_groups(node);
    if (!option_.list) {
      auto scalar = read_element(node);
      if (!scalar) return std::nullopt;
      return std::move(*scalar);
    }
    if (node.kind != YamlNode::Kind::sequence) {  // a single value is a list of one
      auto scalar = read_element(node, as_list(node));
      if (!scalar) return std::nullopt;
      return checked(node, std::vector<OptionScalar>{std::move(*scalar)});
    }
    std::vector<OptionScalar> list;
    for (const auto& item : node.items) {
      if (auto scalar = read_element(item)) list.push_back(std::move(*scalar));
    }
    if (list.size() != node.items.size()) return std::nullopt;
    return checked(node, std::move(list));
  }

 private:
  std::optional<OptionValue> read_groups(const YamlNode& node) {
    const std::size_t before = errors_.size();
    if (node.kind != YamlNode::Kind::map) refuse(node.place, files::describe(node) + " is no map");
    OptionGroups groups;
    for (const auto& [name, place, values] : node.entries) {
      OptionGroup& group = groups.emplace_back(OptionGroup{.name = name, .entries = {}, .place = place});
      if (values.kind != YamlNode::Kind::map && values.kind != YamlNode::Kind::null) {
        refuse(values.place, name + ": " + files::describe(values) + " is no map");
      }
      for (const auto& [parameter, key, value] : values.entries) {
        std::string wrong;
        const auto text = files::read_text(value, wrong);
        if (!text) refuse(value.place, fmt::format("{}.{}: {}", name, parameter, wrong));
        group.entries.push_back({.name = parameter, .value = text.value_or(""), .place = value.place});
      }
    }
    if (errors_.size() != before) return std::nullopt;
    return groups;
  }

  std::optional<OptionScalar> read_element(const YamlNode& node, const std::string& hint = {}) {
    std::string wrong;
    auto scalar = read_scalar(option_, node, folder_, wrong);
    if (!scalar) {
      refuse(node.place, wrong, hint);
      return std::nullopt;
    }
    if (complaint_of_one(option_, *scalar)) {
      const AsWritten written = as_written(option_, *scalar, node.text);
      const auto wrong_value = complaint_of_one(written.option, written.value);
      refuse(written.option, node.place, wrong_value.value_or("is out of range"),
             files::did_you_mean(node.text, option_.choices, {}));
      return std::nullopt;
    }
    return scalar;
  }

  /// Suggestion for values with commas between them and no brackets around them; empty for other nodes.
  static std::string as_list(const YamlNode& node) {
    if (node.kind != YamlNode::Kind::scalar || node.text.find(',') == std::string::npos) return {};
    std::string list;
    std::istringstream values(node.text);
    for (std::string value; std::getline(values >> std::ws, value, ',');)
      list += (list.empty() ? "" : ", ") + value;
    return "did you mean [" + list + "]?";
  }

  std::optional<OptionValue> checked(const YamlNode& node, OptionValue value) {
    if (const auto wrong = complaint(option_, value)) {
      refuse(node.place, *wrong);
      return std::nullopt;
    }
    return value;
  }

  void refuse(const Place& place, const std::string& wrong, const std::string& hint = {}) {
    refuse(option_, place, wrong, hint);
  }
  /// @param expected  the option as a person is to see it
  void refuse(const Option& expected, const Place& place, const std::string& wrong, const std::string& hint) {
    errors_.emplace_back(who_ + ": option '" + option_.name + "': " + wrong,
                         (hint.empty() ? "" : hint + " ") + "expected is " + expectation(expected), place);
  }

  const Option& option_;
  const std::string& who_;
  const std::filesystem::path& folder_;
  std::vector<Error>& errors_;
};

}  // namespace

std::optional<OptionValue> read_option(const Option& option, const YamlNode& node, const std::string& who,
                                       const std::filesystem::path& folder, std::vector<Error>& errors) {
  return Reader(option, who, folder, errors).read(node);
}

}  // namespace crisp::stage
