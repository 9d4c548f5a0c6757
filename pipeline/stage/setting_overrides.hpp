// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <crisp/pipeline.hpp>

#include "pipeline/files/yaml.hpp"

namespace crisp::stage {

/// The settings of a command line, `tag.option=value` and `variable=value`, which go before those of the
/// file.
class Settings {
 public:
  Settings(const std::vector<std::string>& texts, std::vector<Error>& errors);

  /// The value of a variable, if one is set; it counts as used from then on.
  std::optional<files::YamlNode> take_variable(const std::string& name, std::vector<Error>& errors);

  /// Sets the options that are named, and adds an error for each setting that nothing has a use for. Paths
  /// are relative to the current folder.
  void apply(std::vector<StageSpec>& specs, const StageRegistry& stages, std::vector<Error>& errors,
             std::vector<PipelineWarning>& warnings);

 private:
  struct Setting {
    std::string text;    ///< all of it, for messages
    std::string target;  ///< before the =
    std::string value;   ///< behind it
    bool used = false;
  };

  static void apply(Setting& setting, std::vector<StageSpec>& specs, const StageRegistry& stages,
                    std::vector<Error>& errors, std::vector<PipelineWarning>& warnings);

  static files::YamlNode value_of(const StageType& type, const std::string& option, const std::string& value,
                                  const Place& place, std::vector<Error>& errors);

  std::vector<Setting> settings_;
};

}  // namespace crisp::stage
