// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/error.hpp>
#include <crisp/registrar.hpp>

namespace crisp {

/// A tag that a person wrote, and where.
struct TagReference {
  std::string tag;  ///< of another stage of the pipeline
  Place place;      ///< in the pipeline's file
};

/// One stage of a pipeline as requested.
struct StageSpec {
  std::string stage = {};                                ///< name in the registry
  std::string tag = {};                                  ///< empty: the stage's name
  std::optional<std::vector<TagReference>> inputs = {};  ///< absent: the nearest stages above that fit
  std::map<std::string, OptionValue> with = {};          ///< the options that are not at their default
  std::set<std::string> refused = {};                    ///< options with invalid values, already reported
  std::map<std::string, Place> places = {};              ///< where the options were given
  Place place = {};                                      ///< in the pipeline's file
};

/// Tags each stage without a tag by its name, numbered from the second of that name on.
void name_stages(std::vector<StageSpec>& specs);

/// One stage of a pipeline, constructed, configured and connected.
struct PipelineNode {
  const StageType* type = nullptr;                ///< as the registry describes it
  std::string tag;                                ///< by which others name it; no two have the same
  Place place;                                    ///< in the pipeline's file
  std::map<std::string, Place> option_places;     ///< of those that were given
  bool has_valid_options = true;                  ///< its options, each by itself, are right
  std::unique_ptr<Stage> stage;                   ///< with its options set
  std::vector<std::vector<std::size_t>> feeders;  ///< for each of the type's inputs, the nodes that feed it

  /// The place of the option, or else of the stage.
  const Place& place_of(const std::string& option) const {
    const auto given = option_places.find(option);
    return given != option_places.end() ? given->second : place;
  }
  /// The present value of an option.
  OptionValue value(const Option& option) const { return option.get(type->options_object(*stage)); }
};

/// Something that is probably not meant, but can be run.
struct PipelineWarning {
  std::string text;  ///< in words
  Place place;       ///< in the pipeline's file
};

/// Stages in an order in which each is fed only by those before it.
struct Pipeline {
  std::vector<PipelineNode> nodes;        ///< in the order of running
  std::vector<PipelineWarning> warnings;  ///< in the order of the file
};

/// Constructs the stages, sets their options and connects them by kind. Opens no file.
///
/// An input without `inputs` is fed by the nearest stage above that gives its kind; with `inputs`, by all the
/// stages named there that give it, and by no other.
/// @throws Errors all the mistakes that were found
Pipeline build_pipeline(std::vector<StageSpec> specs, const RunSettings& run);

/// The same, but adds mistakes to `errors` instead of throwing, so that a caller can report its own with
/// them. The pipeline is complete only if no error was added.
/// @param rig_is_known  otherwise stages are not checked against it
Pipeline build_pipeline(std::vector<StageSpec> specs, const RunSettings& run, std::vector<Error>& errors,
                        bool rig_is_known = true);

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
