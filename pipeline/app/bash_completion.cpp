// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/bash_completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace crisp::app {
namespace {

// The word behind an option with a value is left to bash's own completion of files, if its values cannot be
// listed. COMPREPLY is split at line breaks only, so that names with blanks stay whole. Bash divides
// name=value into three words, of which the last is to be completed.
constexpr const char* kScript = R"bash(# bash completion of crisp
_crisp() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} name="" command="" at=0 known i
  local IFS=$'\n'
  COMPREPLY=()
  if [[ $word == "=" ]]; then
    name=$before=; before=${{COMP_WORDS[COMP_CWORD-2]}}; word=""
  elif [[ $before == "=" ]]; then
    name=${{COMP_WORDS[COMP_CWORD-2]}}=; before=${{COMP_WORDS[COMP_CWORD-3]}}
  fi
  for ((i = 1; i < COMP_CWORD; i++)); do
    known=${{command:+$command }}${{COMP_WORDS[i]}}
    case $known in
      {names}) command=$known; at=$i ;;
    esac
  done
  local options="" with_value="" values="" verbs="" pipeline="" stages=""
  case $command in
{cases}    *) options=$'{top}' ;;
  esac
  if [[ $before == --set ]]; then
    for ((i = at + 1; i < COMP_CWORD && ${{#pipeline}} == 0; i++)); do
      if [[ ${{COMP_WORDS[i]}} != -* && $'\n'$with_value$'\n' != *$'\n'${{COMP_WORDS[i-1]}}$'\n'* ]]; then
        pipeline=${{COMP_WORDS[i]}}
      fi
    done
    COMPREPLY=($(compgen -W "$("${{COMP_WORDS[0]}}" completion settings $pipeline 2>/dev/null)" -- "$name$word"))
    COMPREPLY=("${{COMPREPLY[@]#"$name"}}")
    if [[ ${{COMPREPLY[0]}} == *= ]]; then compopt -o nospace 2>/dev/null; fi
  elif [[ -n $with_value && $'\n'$with_value$'\n' == *$'\n'$before$'\n'* ]]; then
    COMPREPLY=($(compgen -W "$(sed -n "s/^$before //p" <<<"$values")" -- "$word"))
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
    cases += fmt::format(
        "    '{}') options=$'{}'; with_value=$'{}'; values=$'{}'; verbs=$'{}'; pipeline='{}'; stages={} ;;\n",
        command.name, fmt::join(command.options, "\\n"), fmt::join(command.with_value, "\\n"),
        fmt::join(command.values, "\\n"), fmt::join(command.verbs, "\\n"), command.pipeline,
        command.takes_name ? command.name : "");
  }
  return fmt::format(kScript, fmt::arg("names", fmt::join(names, "|")), fmt::arg("cases", cases),
                     fmt::arg("top", fmt::format("{}\\n--help\\n--version", fmt::join(top, "\\n"))));
}

}  // namespace crisp::app
