// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace crisp {
namespace {

// The word behind an option with a value is left to bash's own completion of files. COMPREPLY is split at
// line breaks only, so that names with blanks stay whole.
constexpr const char* kScript = R"bash(# bash completion of crisp
_crisp() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command="" known i
  local IFS=$'\n'
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    known=${{command:+$command }}${{COMP_WORDS[i]}}
    case $known in
      {names}) command=$known ;;
    esac
  done
  local options="" values="" verbs="" stages=""
  case $command in
{cases}    *) options=$'{top}' ;;
  esac
  if [[ -n $values && $'\n'$values$'\n' == *$'\n'$before$'\n'* ]]; then
    return
  elif [[ $word == -* || -z $command ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  elif [[ -n $verbs && $before == "$command" ]]; then
    COMPREPLY=($(compgen -W "$verbs" -- "$word"))
  elif [[ -n $stages ]]; then
    COMPREPLY=($(compgen -W "$("${{COMP_WORDS[0]}}" $stages --names 2>/dev/null)" -- "$word"))
  fi
}}
complete -o default -F _crisp crisp
)bash";

}  // namespace

std::string bash_completion(const std::vector<CommandWords>& commands) {
  std::vector<std::string> names;  // as patterns: "batch status" is a name, too
  std::vector<std::string> top;
  std::string cases;
  for (const auto& command : commands) {
    names.push_back("'" + command.name + "'");
    if (command.name.find(' ') == std::string::npos) top.push_back(command.name);
    cases += fmt::format("    '{}') options=$'{}'; values=$'{}'; verbs=$'{}'; stages={} ;;\n", command.name,
                         fmt::join(command.options, "\\n"), fmt::join(command.with_value, "\\n"),
                         fmt::join(command.verbs, "\\n"), command.takes_name ? command.name : "");
  }
  return fmt::format(kScript, fmt::arg("names", fmt::join(names, "|")), fmt::arg("cases", cases),
                     fmt::arg("top", fmt::format("{}\\n--help\\n--version", fmt::join(top, "\\n"))));
}

}  // namespace crisp
