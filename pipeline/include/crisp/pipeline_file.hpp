// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <crisp/pipeline.hpp>

namespace crisp {

/// Arguments from outside of the file: they override the file.
struct PipelineArguments {
  std::optional<std::filesystem::path> input = {};   ///< what ${input} stands for
  std::optional<std::filesystem::path> output = {};  ///< what ${output} stands for, a folder
  std::optional<std::filesystem::path> rig = {};     ///< the rig's file
  std::optional<std::string> name = {};              ///< what ${name} stands for; otherwise it is as ${stem}
  std::vector<std::string> set = {};  ///< "tag.option=value", or "variable=value" for one of `vars:`
  bool only_validate = false;         ///< ${input} and ${output} need no value
};

/// A pipeline that is ready to run, and what it came from.
struct LoadedPipeline {
  Pipeline pipeline;               ///< its stages are made and connected
  std::filesystem::path file;      ///< as it was given
  std::filesystem::path rig_file;  ///< empty: the default rig
};

/// Reads the file, makes and connects the stages; sets `run.rig` and `run.output`. Opens no other file than
/// the pipeline's and the rig's.
/// @throws Errors  all mistakes that were found, in the order of the file
LoadedPipeline load_pipeline(const std::filesystem::path& file, const PipelineArguments& arguments,
                             RunSettings& run);

/// The same for a pipeline's text.
/// @param name  to call it by; what paths in it are relative to lies in the folder of such a file
LoadedPipeline load_pipeline(std::string_view text, const std::filesystem::path& name,
                             const PipelineArguments& arguments, RunSettings& run);

}  // namespace crisp
