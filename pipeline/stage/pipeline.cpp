// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <crisp/error.hpp>
#include <crisp/pipeline.hpp>

#include "pipeline/stage/unknown_names.hpp"
#include "pipeline/stage/wiring.hpp"

namespace crisp {
namespace {

class Builder {
 public:
  Builder(const RunSettings& run, std::vector<Error>& errors) : run_(run), errors_(errors) {}

  /// A node of which `type` is null when the stage is not known.
  PipelineNode make(const StageSpec& spec, const std::vector<PipelineNode>& above) {
    PipelineNode node;
    node.place = spec.place;
    node.option_places = spec.places;
    node.tag = spec.tag;
    check_tag(node, above);
    node.type = run_.registrar->stages().find(spec.stage);
    if (!node.type) {
      const Error unknown = stage::no_such_stage(spec.stage, run_.registrar->stages());
      fail(spec.place, unknown.message(), unknown.advice());
      return node;
    }
    node.stage = node.type->make();
    const std::size_t before = errors_.size();
    set_options(node, spec);
    node.has_valid_options = errors_.size() == before && spec.refused.empty();
    return node;
  }

  /// Checks that a stage's options agree with each other and the rig.
  void check(const PipelineNode& node) {
    const auto report = [&](const Error& error) {
      fail(error.place().file.empty() ? node.place_of(error.option()) : error.place(),
           node.tag + ": " + error.message(), error.advice());
    };
    for_each_error([&] { node.stage->check(run_); }, report);
  }

 private:
  void fail(const Place& place, std::string what, std::string advice) {
    errors_.emplace_back(std::move(what), std::move(advice), place);
  }

  void check_tag(const PipelineNode& node, const std::vector<PipelineNode>& above) {
    const auto same =
        std::find_if(above.begin(), above.end(), [&](const auto& n) { return n.tag == node.tag; });
    if (same == above.end()) return;
    fail(node.place, fmt::format("the tag '{}' is used twice", node.tag),
         "the other is at " + to_string(same->place));
  }

  void set_options(PipelineNode& node, const StageSpec& spec) {
    void* object = node.type->options_object(*node.stage);
    for (const auto& [name, value] : spec.with) {
      const Option* option = node.type->find_option(name);
      if (!option) {
        fail(spec.place, fmt::format("{}: there is no option '{}'", node.tag, name),
             stage::no_such_option(*node.type, name));
      } else if (const auto wrong = complaint(*option, value)) {
        fail(spec.place, fmt::format("{}: option '{}' {}", node.tag, name, *wrong),
             "expected is " + expectation(*option));
      } else {
        option->set(object, value);
      }
    }
    for (const auto& option : node.type->options) {
      if (option.required && !spec.with.contains(option.name) && !spec.refused.contains(option.name)) {
        fail(spec.place, fmt::format("{}: option '{}' is missing ({})", node.tag, option.name, option.help),
             "expected is " + expectation(option));
      }
    }
  }

  const RunSettings& run_;
  std::vector<Error>& errors_;
};

}  // namespace

void name_stages(std::vector<StageSpec>& specs) {
  for (auto spec = specs.begin(); spec != specs.end(); ++spec) {
    const auto taken = [&](const std::string& tag) {
      return std::any_of(specs.begin(), spec, [&](const auto& above) { return above.tag == tag; });
    };
    if (!spec->tag.empty()) continue;
    spec->tag = spec->stage;
    for (int i = 2; taken(spec->tag); ++i) spec->tag = fmt::format("{}-{}", spec->stage, i);
  }
}

Pipeline build_pipeline(std::vector<StageSpec> specs, const RunSettings& run, std::vector<Error>& errors,
                        bool rig_is_known) {
  name_stages(specs);
  Pipeline pipeline;
  Builder builder(run, errors);
  for (const auto& spec : specs) pipeline.nodes.push_back(builder.make(spec, pipeline.nodes));
  stage::connect(pipeline, specs, run.registrar->stages(), errors);
  for (const auto& node : pipeline.nodes) {
    if (node.type && node.has_valid_options && rig_is_known) builder.check(node);
  }
  if (errors.empty()) pipeline.warnings = stage::put_too_low(pipeline);
  return pipeline;
}

Pipeline build_pipeline(std::vector<StageSpec> specs, const RunSettings& run) {
  std::vector<Error> errors;
  Pipeline pipeline = build_pipeline(std::move(specs), run, errors);
  if (!errors.empty()) throw Errors(std::move(errors));
  return pipeline;
}

}  // namespace crisp
