// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <crisp/option.hpp>

#include "pipeline/files/list_files.hpp"
#include "pipeline/files/quantity.hpp"

namespace crisp {
namespace {

std::string type_name(const Option& option) {
  switch (option.type) {
    case OptionType::boolean:
      return "true or false";
    case OptionType::integer:
      return "a whole number";
    case OptionType::number:
      return option.unit.empty() || option.unit == "1" ? "a number" : "a number in " + option.unit;
    case OptionType::text:
      return "a text";
    case OptionType::choice:
      return "a name";
    case OptionType::path:
      return option.ending.empty() ? "a path" : "a path that ends in " + option.ending;
    case OptionType::groups:
      return "a map of maps: {name: {parameter: value}}";
  }
  return {};
}

std::string bounds(const Option& option) {
  const bool below = std::isfinite(option.max) && std::abs(option.max) < 9e18;
  const bool above = std::isfinite(option.min) && std::abs(option.min) < 9e18;
  // Whole numbers in full, others as short as they read well.
  const auto text = [&](double value) {
    return option.type == OptionType::integer ? fmt::format("{:.0f}", value) : fmt::format("{:g}", value);
  };
  if (above && below) return text(option.min) + " to " + text(option.max);
  if (above) return "at least " + text(option.min);
  if (below) return "at most " + text(option.max);
  return {};
}

/// Allowed number of a list's elements, in words.
std::string counts(const Option& option) {
  const bool limited = option.max_count != std::numeric_limits<std::size_t>::max();
  if (option.min_count == option.max_count) return fmt::format(", {} of them", option.min_count);
  std::string text;
  if (option.min_count > 0) text += fmt::format(", {} or more of them", option.min_count);
  if (limited) text += fmt::format(", {} at most", option.max_count);
  return text;
}

std::string group_text(const OptionGroup& group) {
  std::vector<std::string> entries;
  for (const auto& [name, value, place] : group.entries)
    entries.push_back(fmt::format("{}: {}", name, value));
  return fmt::format("{}: {{{}}}", group.name, fmt::join(entries, ", "));
}

bool has_type(const Option& option, const OptionScalar& scalar) {
  switch (option.type) {
    case OptionType::boolean:
      return std::holds_alternative<bool>(scalar);
    case OptionType::integer:
      return std::holds_alternative<std::int64_t>(scalar);
    case OptionType::number:
      return std::holds_alternative<double>(scalar);
    default:
      return std::holds_alternative<std::string>(scalar);
  }
}

/// A number as a person would write it: angles in degrees where that is shorter and reads back as the same.
std::string number_text(double value, const std::string& unit) {
  std::string plain = fmt::format("{}{}", value, unit == "1" ? "" : unit);
  if (unit != "rad") return plain;
  std::string degrees = fmt::format("{:.10g}deg", value * 180 / std::numbers::pi);
  const auto back = files::parse_quantity(degrees, unit);
  const bool same = std::holds_alternative<double>(back) && std::get<double>(back) == value;
  return same && degrees.size() < plain.size() ? degrees : plain;
}

std::string scalar_text(const Option& option, const OptionScalar& scalar) {
  struct Printer {
    const std::string& unit;
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(double value) const { return number_text(value, unit); }
    std::string operator()(const std::string& value) const { return value; }
  };
  return std::visit(Printer{option.unit}, scalar);
}

std::optional<std::string> complaint_of_text(const Option& option, const std::string& text) {
  if (!option.choices.empty() && std::ranges::find(option.choices, text) == option.choices.end()) {
    return fmt::format("'{}' is not one of its names", text);
  }
  if (!option.ending.empty() && !files::has_extension(text, {option.ending})) {
    return fmt::format("'{}' is no name of a {} file", text, option.ending);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> complaint_of_one(const Option& option, const OptionScalar& scalar) {
  if (!has_type(option, scalar)) return "is of the wrong type";
  double number = 0;
  if (const auto* integer = std::get_if<std::int64_t>(&scalar)) number = static_cast<double>(*integer);
  if (const auto* real = std::get_if<double>(&scalar)) {
    number = *real;
    if (!std::isfinite(number)) return "is not a finite number";
  }
  if (number < option.min || number > option.max) {
    return fmt::format("{} is out of range", scalar_text(option, scalar));
  }
  const auto* text = std::get_if<std::string>(&scalar);
  return text ? complaint_of_text(option, *text) : std::nullopt;
}

std::optional<std::string> complaint(const Option& option, const OptionValue& value) {
  if (std::holds_alternative<std::monostate>(value)) {
    if (option.may_be_auto) return std::nullopt;
    return "cannot be 'auto'";
  }
  const bool groups = std::holds_alternative<OptionGroups>(value);
  if (groups != (option.type == OptionType::groups)) return groups ? "is a map of maps" : "is no map of maps";
  if (groups) return std::nullopt;
  const auto* list = std::get_if<std::vector<OptionScalar>>(&value);
  if (option.list != (list != nullptr)) return option.list ? "is not a list" : "is a list";
  if (!list) return complaint_of_one(option, std::get<OptionScalar>(value));
  if (list->size() < option.min_count || list->size() > option.max_count) {
    return fmt::format("has {} elements", list->size());
  }
  for (const auto& scalar : *list) {
    if (auto wrong = complaint_of_one(option, scalar)) return wrong;
  }
  return std::nullopt;
}

std::string expectation(const Option& option) {
  std::string text =
      option.choices.empty() ? type_name(option) : fmt::format("one of {}", fmt::join(option.choices, ", "));
  if (const auto limits = bounds(option); !limits.empty() && option.choices.empty()) text += ", " + limits;
  if (option.list) {
    text = "a list, each " + text;
    text += counts(option);
  }
  if (option.may_be_auto) text += ", or auto";
  return text;
}

std::string to_text(const Option& option, const OptionValue& value) {
  if (std::holds_alternative<std::monostate>(value)) return "auto";
  if (const auto* scalar = std::get_if<OptionScalar>(&value)) return scalar_text(option, *scalar);
  std::vector<std::string> elements;
  if (const auto* groups = std::get_if<OptionGroups>(&value)) {
    for (const auto& group : *groups) elements.push_back(group_text(group));
    return fmt::format("{{{}}}", fmt::join(elements, ", "));
  }
  for (const auto& scalar : std::get<std::vector<OptionScalar>>(value)) {
    elements.push_back(scalar_text(option, scalar));
  }
  return fmt::format("[{}]", fmt::join(elements, ", "));
}

}  // namespace crisp
