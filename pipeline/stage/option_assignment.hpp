// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <crisp/pipeline.hpp>

#include "pipeline/files/yaml.hpp"

namespace crisp::stage {

/// Assigns values in YAML to the options of a stage, by their names or as maps of their groups.
class OptionAssignment {
 public:
  /// @param type    of the stage
  /// @param spec    receives the values, and the names of those that are refused
  /// @param folder  what relative paths are relative to
  OptionAssignment(const StageType& type, StageSpec& spec, std::filesystem::path folder,
                   std::vector<Error>& errors, std::vector<PipelineWarning>& warnings);

  /// Assigns the value to the option, or the map's entries to the group's options. Adds an error for each
  /// that is unknown or wrong, and a warning for each name of an earlier release.
  /// @param name      "sigma", "motion", "motion.kind"
  /// @param key       where the name is written
  /// @param is_known  otherwise the value is incomplete, which was reported, and its options count as refused
  void assign(const std::string& name, const Place& key, const files::YamlNode& value, bool is_known = true);

 private:
  bool is_of_group(const std::string& name, const files::YamlNode& value) const;
  void refuse_name(const std::string& name, const Place& key);

  const StageType& type_;
  StageSpec& spec_;
  std::string who_;
  std::filesystem::path folder_;
  std::vector<Error>& errors_;
  std::vector<PipelineWarning>& warnings_;
};

}  // namespace crisp::stage
