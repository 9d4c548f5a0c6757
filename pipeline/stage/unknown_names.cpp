// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/unknown_names.hpp"

#include <vector>

#include "pipeline/files/nearest.hpp"

namespace crisp {

Error no_such_stage(const std::string& name, const StageRegistry& stages) {
  return Error("there is no stage '" + name + "'",
               did_you_mean(name, stages.names(), "crisp stages lists them;") +
                   " a plugin's are known with --plugin FILE");
}

std::string no_such_option(const StageType& type, const std::string& name) {
  std::vector<std::string> known;
  for (const auto& option : type.options) known.push_back(option.name);
  return did_you_mean(name, known,
                      known.empty() ? "it has none" : "crisp stages " + type.name + " lists them");
}

}  // namespace crisp
