// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace crisp::app {

/// Words that can follow one of the program's commands.
struct CommandWords {
  std::string name;                     ///< "run", or with a verb "batch status"
  std::vector<std::string> options;     ///< "--seed", "-i", …
  std::vector<std::string> with_value;  ///< those of them behind which a value stands
  std::vector<std::string> values;      ///< values that can be listed: "--scene office"
  std::vector<std::string> verbs;       ///< that may stand next: "status"
  std::string
      pipeline;  ///< the installed one that the command runs; empty: its first argument, if it runs one
  bool takes_name = false;  ///< its argument is what the command lists: a stage, an effect
};

/// A script for bash that completes commands, options, stage names, settings and files; to be sourced, or
/// installed as /usr/share/bash-completion/completions/crisp.
std::string bash_completion(const std::vector<CommandWords>& commands);

}  // namespace crisp::app
