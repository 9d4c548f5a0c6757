// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/slurm_script.hpp"

#include <algorithm>
#include <charconv>

namespace crisp::batch {
namespace {

constexpr std::string_view kDirective = "#SBATCH --";
constexpr std::string_view kArgumentsLine = "# crisp cluster submit writes the program";

/// Position of the first line that begins with a text; npos: there is none.
std::size_t find_line(std::string_view script, std::string_view beginning) {
  if (script.starts_with(beginning)) return 0;
  const std::size_t found = script.find("\n" + std::string(beginning));
  return found == std::string_view::npos ? found : found + 1;
}

void replace_line(std::string& script, std::size_t begin, const std::string& line) {
  script.replace(begin, script.find('\n', begin) - begin, line);
}

/// sbatch takes a value with a blank in double quotes.
std::string directive(const std::string& name, const std::string& value) {
  std::string begin = std::string(kDirective) + name;
  if (value.empty()) return begin;
  if (value.find_first_of(" \t\"'\\#") == std::string::npos) return begin + "=" + value;
  std::string quoted;
  for (const char c : value) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return begin + "=\"" + quoted + "\"";
}

/// @param name  "partition"; an option without value, such as "exclusive", has the value ""
void set_option(std::string& script, const std::string& name, const std::string& value) {
  const std::string line = directive(name, value);
  std::size_t own = find_line(script, std::string(kDirective) + name + "=");
  if (own == std::string::npos) own = find_line(script, std::string(kDirective) + name + "\n");
  if (own != std::string::npos) return replace_line(script, own, line);
  const std::size_t last = script.rfind("\n" + std::string(kDirective)) + 1;
  script.insert(script.find('\n', last) + 1, line + "\n");
}

}  // namespace

std::string complete_slurm_script(std::string_view script, const SlurmScriptValues& values) {
  std::string text(script);
  for (const auto& [name, value] : values.options) set_option(text, name, value);
  std::string arguments = "CRISP=" + bash_quoted(values.program) + "\nset --";
  for (const auto& word : values.words) arguments += " " + bash_quoted(word);
  replace_line(text, find_line(text, kArgumentsLine), arguments);
  return text;
}

std::string bash_quoted(std::string_view word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string{c};
  return quoted + "'";
}

std::string slurm_log_path(std::string_view path) {
  std::string text;
  for (const char c : path) text += c == '%' ? "%%" : std::string{c};
  return text;
}

std::optional<std::uint64_t> longest_slurm_array(std::string_view config) {
  const std::size_t line = find_line(config, "MaxArraySize");
  if (line == std::string_view::npos) return std::nullopt;
  const std::string_view rest = config.substr(line, config.find('\n', line) - line);
  const std::size_t digit = rest.find_first_of("0123456789");
  if (digit == std::string_view::npos) return std::nullopt;
  std::uint64_t size = 0;
  std::from_chars(rest.data() + digit, rest.data() + rest.size(), size);
  return std::max<std::uint64_t>(size, 1) - 1;
}

}  // namespace crisp::batch
