// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/reference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace crisp::stage {
namespace {

struct OptionRow {
  std::string name;
  std::string value;
  std::string fallback;
  std::string help;
};

/// The options of one group, by their names in it; the group without a name has all that are in none.
struct OptionTable {
  std::string group;
  std::vector<OptionRow> rows;
};

/// The group without a name first, then each where its first option is declared.
std::vector<OptionTable> tables_of(const StageType& type) {
  const auto stage = type.make();
  std::vector<OptionTable> tables(1);
  for (const auto& option : type.options) {
    const auto dot = option.name.rfind('.');
    const bool in_group = dot != std::string::npos;
    const std::string group = in_group ? option.name.substr(0, dot) : "";
    auto table = std::ranges::find(tables, group, &OptionTable::group);
    if (table == tables.end()) table = tables.insert(table, {.group = group, .rows = {}});
    const std::string fallback =
        option.required ? "required" : to_text(option, option.get(type.options_object(*stage)));
    table->rows.push_back({option.name.substr(in_group ? dot + 1 : 0), expectation(option),
                           fallback.empty() ? "\"\"" : fallback, option.help});
  }
  return tables;
}

/// "links: {laser: {delay: …}}", how the first option of a group is written.
std::string as_map(const OptionTable& table) {
  std::string text = table.rows.front().name + ": …";
  for (std::string rest = table.group; !rest.empty();) {
    const auto dot = rest.rfind('.');
    text = fmt::format("{}: {{{}}}", rest.substr(dot == std::string::npos ? 0 : dot + 1), text);
    rest = dot == std::string::npos ? "" : rest.substr(0, dot);
  }
  return text;
}

std::string_view role_of(const StageInput& input) {
  if (input.held) return input.required ? "holds the latest" : "holds the latest, if one is given";
  return input.required ? "takes each" : "takes each, if one is given";
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// A text as a cell of a table.
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) {
    text.insert(at, "\\");
  }
  return text;
}

}  // namespace

std::string stage_text(const StageType& type) {
  std::string text = fmt::format("{}: {} ({})\n", type.name, type.summary, type.origin);
  if (!type.details.empty()) text += "\n" + type.details + "\n";
  text += "\n";
  for (const auto& input : type.inputs) text += fmt::format("  {} {}\n", role_of(input), input.kind.name());
  for (const auto& kind : type.outputs) text += fmt::format("  gives {}\n", kind.name());
  for (const auto& table : tables_of(type)) {
    if (table.rows.empty()) continue;
    text += table.group.empty() ? "\noptions:\n"
                                : fmt::format("\n{} ({}):\n", as_map(table), type.groups.at(table.group));
    for (const auto& row : table.rows) {
      text +=
          fmt::format("  {:<16} {}\n{:19}{}; default: {}\n", row.name, row.help, "", row.value, row.fallback);
    }
  }
  return text;
}

std::string stage_markdown(const StageType& type) {
  std::string text = fmt::format("# {}\n\n{}.\n", type.name, capitalised(type.summary));
  if (!type.details.empty()) text += "\n" + type.details + "\n";
  text += "\n| flow | kind |\n|---|---|\n";
  for (const auto& input : type.inputs)
    text += fmt::format("| {} | `{}` |\n", role_of(input), input.kind.name());
  for (const auto& kind : type.outputs) text += fmt::format("| gives | `{}` |\n", kind.name());
  if (type.options.empty()) return text + "\nIt has no options.\n";
  for (const auto& table : tables_of(type)) {
    if (table.rows.empty()) continue;
    if (!table.group.empty()) {
      text += fmt::format("\n## {}\n\n{}, written as `{}`.\n", table.group,
                          capitalised(type.groups.at(table.group)), as_map(table));
    }
    text += "\n| option | value | default | meaning |\n|---|---|---|---|\n";
    for (const auto& row : table.rows) {
      text += fmt::format("| `{}` | {} | {} | {} |\n", row.name, cell(row.value), cell(row.fallback),
                          cell(row.help));
    }
  }
  return text;
}

std::string index_markdown(const StageRegistry& stages) {
  std::string text =
      "# Stages\n\n`crisp stages --markdown --output docs/reference` writes these pages from the stages' declarations.\n";
  std::string family;
  for (const auto* type : stages.all()) {
    const std::string of = type->name.substr(0, type->name.find('.'));
    if (of != family) text += fmt::format("\n## {}\n\n| stage | what it does |\n|---|---|\n", of);
    family = of;
    text += fmt::format("| [{0}]({0}.md) | {1} |\n", type->name, cell(type->summary));
  }
  return text;
}

nlohmann::json to_json(const OptionValue& value) {
  const auto scalar_json = [](const OptionScalar& scalar) {
    return std::visit([](const auto& v) { return nlohmann::json(v); }, scalar);
  };
  if (const auto* scalar = std::get_if<OptionScalar>(&value)) return scalar_json(*scalar);
  if (std::holds_alternative<std::monostate>(value)) return "auto";
  if (const auto* groups = std::get_if<OptionGroups>(&value)) {
    auto object = nlohmann::json::object();
    for (const auto& group : *groups) {
      auto& entries = object[group.name] = nlohmann::json::object();
      for (const auto& entry : group.entries) entries[entry.name] = entry.value;
    }
    return object;
  }
  auto array = nlohmann::json::array();
  for (const auto& scalar : std::get<std::vector<OptionScalar>>(value)) array.push_back(scalar_json(scalar));
  return array;
}

nlohmann::ordered_json effective_options(const PipelineNode& node) {
  auto options = nlohmann::ordered_json::object();
  for (const auto& option : node.type->options) {
    std::string path = "/" + option.name;
    std::ranges::replace(path, '.', '/');
    options[nlohmann::ordered_json::json_pointer(path)] = to_json(node.value(option));
  }
  return options;
}

}  // namespace crisp::stage
