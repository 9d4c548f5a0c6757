// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/usage_message.hpp"

#include <algorithm>
#include <vector>

#include "pipeline/files/nearest.hpp"

namespace crisp::app {
namespace {

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// CLI11 lists unexpected arguments in reverse order.
std::string not_expected(const CLI::App& command) {
  const std::vector<std::string> words = command.remaining();
  std::string text = "not expected:";
  for (const auto& word : words) text += " " + word;
  const auto option = std::ranges::find_if(words, [](const auto& word) { return word.starts_with("--"); });
  if (option == words.end()) return text;
  const std::string name = option->substr(0, option->find('='));
  const std::string hint = files::did_you_mean(name, options_of(command), {});
  return hint.empty() ? text : text + "; " + hint;
}

}  // namespace

std::string usage_error(const CLI::App& app, const CLI::Error& error) {
  const CLI::App* command = &app;  // the innermost that was named
  std::string name = app.get_name();
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    name += " " + command->get_name();
  }
  const bool extras = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const std::string what = extras ? not_expected(*command) : error.what();
  return "error: " + what + "; see " + name + " --help\n";
}

}  // namespace crisp::app
