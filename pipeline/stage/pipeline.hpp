// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/data/error.hpp"
#include "pipeline/stage/context.hpp"
#include "pipeline/stage/registry.hpp"

namespace crisp {

/// A tag that a person wrote, and where.
struct TagReference {
  std::string tag;
  Place place;
};

/// One stage of a pipeline as it was asked for.
struct StageSpec {
  std::string stage = {};                                ///< name in the registry
  std::string tag = {};                                  ///< empty: the stage's name
  std::optional<std::vector<TagReference>> inputs = {};  ///< absent: the nearest stages above that fit
  std::map<std::string, OptionValue> with = {};          ///< the options that are not at their default
  std::set<std::string> refused = {};                    ///< options that were given, wrongly, which was said
  std::map<std::string, Place> places = {};              ///< where the options were given
  Place place = {};
};

/// Gives a tag to each stage that has none: its name, numbered from the second of that name on.
void name_stages(std::vector<StageSpec>& specs);

/// One stage of a pipeline, made, told its options and connected.
struct PipelineNode {
  const StageType* type = nullptr;
  std::string tag;
  Place place;
  std::map<std::string, Place> option_places;  ///< of those that were given
  bool is_told = true;                         ///< its options, each by itself, are right
  std::unique_ptr<Stage> stage;
  std::vector<std::vector<std::size_t>> feeders;  ///< for each of the type's inputs, the nodes that feed it

  /// Where the option was given, or else the stage.
  const Place& place_of(const std::string& option) const {
    const auto given = option_places.find(option);
    return given != option_places.end() ? given->second : place;
  }
  OptionValue value(const Option& option) const { return option.get(type->options_object(*stage)); }
};

/// Something that is probably not meant, but can be run.
struct PipelineWarning {
  std::string text;
  Place place;
};

/// Stages in an order in which each is fed only by those before it.
struct Pipeline {
  std::vector<PipelineNode> nodes;
  std::vector<PipelineWarning> warnings;
};

/// Makes the stages, sets their options and connects them by kind. Opens no file.
///
/// An input without `inputs` is fed by the nearest stage above that gives its kind; with `inputs`, by all the
/// stages named there that give it, and by no other.
/// @throws Errors all the mistakes that were found
Pipeline build_pipeline(std::vector<StageSpec> specs, const RunSettings& run);

/// The same, but adds mistakes to `errors` instead of throwing, so that a caller can report its own with
/// them. The pipeline is complete only if no error was added.
/// @param rig_is_known  or else the stages are not asked whether they fit it
Pipeline build_pipeline(std::vector<StageSpec> specs, const RunSettings& run, std::vector<Error>& errors,
                        bool rig_is_known = true);

}  // namespace crisp
