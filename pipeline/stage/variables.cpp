// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/variables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <set>

#include "pipeline/files/nearest.hpp"

namespace crisp::stage {

using files::YamlNode;

void Variables::set(const std::string& name, const std::string& text) {
  YamlNode node;
  node.kind = YamlNode::Kind::scalar;
  node.text = text;
  set(name, std::move(node));
}

void Variables::substitute(YamlNode& node, std::vector<Error>& errors) {
  if (node.kind == YamlNode::Kind::scalar) substitute_scalar(node, errors);
  for (auto& item : node.items) substitute(item, errors);
  for (auto& entry : node.entries) substitute(entry.value, errors);
}

void Variables::substitute_scalar(YamlNode& node, std::vector<Error>& errors) {
  const std::string text = std::move(node.text);
  node.text.clear();
  std::size_t done = 0;
  while (true) {
    const std::size_t start = text.find("${", done);
    node.text += text.substr(done, start - done);
    if (start == std::string::npos) return;
    const std::size_t end = text.find('}', start);
    if (start > done && text[start - 1] == '$') {
      node.text += "{";  // of "$${" the first $ is there already
      done = start + 2;
      continue;
    }
    if (end == std::string::npos) {
      errors.emplace_back("'" + text.substr(start, 20) + "' has no }", "write ${name}, or $${ for ${ itself",
                          node.place);
      return;
    }
    done = end + 1;
    const YamlNode* value = find(text.substr(start + 2, end - start - 2), node.place, errors);
    if (!value) continue;
    count(*value, node.place);
    if (start == 0 && done == text.size()) {  // stands alone: a list or map may take its place
      const Place place = node.place;
      node = *value;
      node.place = place;
      return;
    }
    if (value->kind != YamlNode::Kind::scalar) {
      errors.emplace_back(text.substr(start, done - start) + " is " + files::describe(*value),
                          "let it stand alone", node.place);
      continue;
    }
    if (start == 0) node.from_command_line = value->from_command_line;
    node.text += value->text;
  }
}

void Variables::count(const YamlNode& value, const Place& place) {
  constexpr std::size_t kMax = 1 << 20;
  put_in_ += 1 + value.text.size();
  if (put_in_ > kMax)
    throw Error("the variables' expansion exceeds one mebibyte",
                "shorten vars, or use fewer of them in each other", place);
  for (const auto& item : value.items) count(item, place);
  for (const auto& entry : value.entries) count(entry.value, place);
}

const YamlNode* Variables::find(const std::string& name, const Place& place,
                                std::vector<Error>& errors) const {
  const auto found = values_.find(name);
  if (found != values_.end()) return &found->second;
  if (const auto missing = missing_.find(name); missing != missing_.end()) {
    errors.emplace_back("${" + name + "} has no value", missing->second, place);
    return nullptr;
  }
  std::set<std::string> names = {"input", "output"};
  for (const auto& [key, value] : values_) names.insert(key);
  const std::vector<std::string> known(names.begin(), names.end());
  const bool is_of_environment = std::getenv(name.c_str()) != nullptr;
  errors.emplace_back(
      fmt::format("there is no variable '{}'{}", name,
                  is_of_environment ? "; environment variables are not read" : ""),
      is_of_environment
          ? fmt::format("declare it under vars, and give it with --set {}=VALUE", name)
          : files::did_you_mean(name, known, fmt::format("known are {}", fmt::join(known, ", "))),
      place);
  return nullptr;
}

}  // namespace crisp::stage
