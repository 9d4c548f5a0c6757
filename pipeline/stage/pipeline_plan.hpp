// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <crisp/pipeline.hpp>

#include "pipeline/files/yaml.hpp"

namespace crisp::stage {

/// A pipeline as its file describes it.
struct PipelinePlan {
  Rig rig = default_rig();
  bool rig_is_known = true;        ///< false: the requested rig has mistakes
  std::filesystem::path rig_file;  ///< empty: the default rig
  std::vector<StageSpec> stages;
  std::vector<PipelineWarning> warnings;  ///< names of an earlier release
};

/// Reads a pipeline's YAML (docs/reference/pipelines.md), the rig that it names included. Adds all mistakes
/// to `errors`; the plan is of use only to find further ones if there are any.
PipelinePlan parse_plan(const files::YamlNode& root, const std::filesystem::path& folder,
                        const PipelineArguments& arguments, const StageRegistry& stages,
                        std::vector<Error>& errors);

/// load_pipeline() of a file that was read already.
LoadedPipeline load_pipeline(const files::YamlNode& root, const std::filesystem::path& file,
                             const PipelineArguments& arguments, RunSettings& run);

}  // namespace crisp::stage
