// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>

#include <crisp/error.hpp>
#include <crisp/pipeline.hpp>
#include <crisp/rig_file.hpp>

#include "pipeline/files/file_kind.hpp"
#include "pipeline/files/nearest.hpp"
#include "pipeline/files/rig_yaml.hpp"
#include "pipeline/files/yaml_map.hpp"
#include "pipeline/stage/files_written.hpp"
#include "pipeline/stage/option_assignment.hpp"
#include "pipeline/stage/pipeline_plan.hpp"
#include "pipeline/stage/setting_overrides.hpp"
#include "pipeline/stage/unknown_names.hpp"
#include "pipeline/stage/variables.hpp"

namespace crisp {
namespace {

using files::YamlNode;
namespace fs = std::filesystem;

/// Value of ${output} where a pipeline is only validated.
const fs::path kNoOutput = "/output";

class PlanReader {
 public:
  PlanReader(const fs::path& folder, const PipelineArguments& arguments, const StageRegistry& stages,
             std::vector<Error>& errors)
      : folder_(folder),
        arguments_(arguments),
        stages_(stages),
        errors_(errors),
        settings_(arguments.set, errors) {}

  stage::PipelinePlan read(const YamlNode& root) {
    files::YamlMap map(root, "pipeline", errors_);
    files::check_schema(map, 1);
    set_arguments();
    if (const YamlNode* vars = map.find("vars")) read_variables(*vars);
    read_rig_of(map.find("rig"));
    if (const YamlNode* list = map.require("pipeline")) read_stages(*list);
    map.refuse_others();
    settings_.apply(plan_.stages, stages_, errors_, plan_.warnings);
    return std::move(plan_);
  }

 private:
  void set_arguments() {
    const auto set = [&](const std::string& name, const std::optional<fs::path>& path, const char* advice) {
      if (path)
        variables_.set(name, fs::absolute(*path).lexically_normal().string());
      else if (arguments_.only_validate)
        variables_.set(name, "/" + name);  // as kNoOutput
      else
        variables_.set_missing(name, advice);
    };
    set("input", arguments_.input, "give it with -i");
    set("output", arguments_.output, "give it with -o");
    set_name();
  }

  /// ${stem} is the name of the input's file without its ending, ${name} that of a batch's recording.
  void set_name() {
    const fs::path given = arguments_.input.value_or(fs::path());
    const fs::path input = given.has_filename() ? given : given.parent_path();
    std::error_code none;
    const std::string stem = (fs::is_directory(input, none) ? input.filename() : input.stem()).string();
    for (const char* variable : {"stem", "name"}) {
      if (arguments_.only_validate || !stem.empty())
        variables_.set(variable, stem.empty() ? "input" : stem);
      else
        variables_.set_missing(variable, "give an input with -i");
    }
    if (arguments_.name) variables_.set("name", *arguments_.name);
  }

  void read_variables(const YamlNode& node) {
    files::YamlMap map(node, "vars", errors_);
    for (const auto& [name, place, value] : node.entries) {
      if (name == "input" || name == "output") {
        map.fail(place, "'" + name + "' is set by the command line", "choose another name");
        continue;
      }
      YamlNode known = value;
      if (const auto given = settings_.take_variable(name, errors_))
        known = *given;
      else
        variables_.substitute(known, errors_);  // a variable may use those above it
      variables_.set(name, std::move(known));
    }
  }

  void read_rig_of(const YamlNode* node) {
    if (arguments_.rig) return use_rig(fs::absolute(*arguments_.rig), {});
    if (!node) return;
    YamlNode rig = *node;
    const std::size_t before = errors_.size();
    variables_.substitute(rig, errors_);
    plan_.rig_is_known = errors_.size() == before;
    if (rig.kind == YamlNode::Kind::scalar) {
      if (plan_.rig_is_known) use_rig(files::path_of(rig, folder_), rig.place);
      return;
    }
    take_rig([&] { plan_.rig = files::parse_rig(rig); }, rig.place);
  }

  void use_rig(const fs::path& file, const Place& place) {
    plan_.rig_file = file.lexically_normal();
    take_rig([&] { plan_.rig = read_rig(plan_.rig_file); }, place);
  }

  /// Adds what `read` throws to the errors, at `place` where it has no place of its own.
  template <class Read>
  void take_rig(Read read, const Place& place) {
    for_each_error(read, [&](const Error& error) {
      plan_.rig_is_known = false;
      errors_.emplace_back(error.message(), error.advice(), error.place().line ? error.place() : place);
    });
  }

  void read_stages(const YamlNode& list) {
    if (list.kind != YamlNode::Kind::sequence) {
      errors_.emplace_back("pipeline: " + files::describe(list) + " is not a list of stages",
                           "begin each with '- stage:'", list.place);
    } else if (list.items.empty()) {
      errors_.emplace_back("pipeline: there is no stage in it", "add `- stage: NAME`", list.place);
    }
    constexpr std::size_t kMax = 1000;
    if (list.items.size() > kMax) {
      errors_.emplace_back(fmt::format("pipeline: there are more than {} stages", kMax),
                           "split it into several pipelines", list.place);
      return;
    }
    for (const auto& item : list.items) read_stage(item);
  }

  void read_stage(const YamlNode& node) {
    if (node.kind == YamlNode::Kind::scalar) {
      errors_.emplace_back("stage: " + files::describe(node) + " is not a map",
                           "write `- stage: " + without_key(node.text) + "`", node.place);
      return;
    }
    files::YamlMap map(node, "stage", errors_);
    StageSpec spec;
    spec.place = node.place;
    const YamlNode* name = map.require("stage");
    if (name) spec.place = name->place;
    spec.stage = current(files::RenamedName::Kind::stage, "", map.text("stage", ""), spec.place);
    spec.tag = map.text("tag", "");
    if (const YamlNode* tag = map.find("tag"); tag && !is_tag(spec.tag)) {
      map.fail(tag->place, files::describe(*tag) + " is not a tag",
               "tags are of letters, digits, '_', '-' and '.'");
    }
    if (const YamlNode* inputs = map.find("inputs")) spec.inputs = read_inputs(*inputs, map);
    if (const YamlNode* with = map.find("with")) read_options(*with, spec);
    map.refuse_others();
    if (!spec.stage.empty()) plan_.stages.push_back(std::move(spec));
  }

  std::string current(files::RenamedName::Kind kind, std::string_view owner, const std::string& name,
                      const Place& place) {
    return stage::accept_old_name(kind, owner, name, place, plan_.warnings);
  }

  /// The stage's name where the colon behind `stage` is missing, or the blank behind that.
  static std::string without_key(const std::string& text) {
    constexpr std::string_view kKey = "stage";
    const std::size_t name = text.find_first_not_of(": ", kKey.size());
    const bool has_key = text.starts_with(kKey) && name != std::string::npos && name > kKey.size();
    return has_key ? text.substr(name) : text;
  }

  static bool is_tag(const std::string& tag) {
    const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.'; };
    return !tag.empty() && std::all_of(tag.begin(), tag.end(), allowed);
  }

  std::vector<TagReference> read_inputs(const YamlNode& node, files::YamlMap& map) {
    std::vector<TagReference> inputs;
    const auto add = [&](const std::string& tag, const Place& place) {
      inputs.push_back({current(files::RenamedName::Kind::stage, "", tag, place), place});
    };
    if (node.kind == YamlNode::Kind::scalar)
      add(node.text, node.place);
    else if (node.kind != YamlNode::Kind::sequence)
      map.fail(node.place, files::describe(node) + " is not a list of tags", "write inputs: [TAG, TAG]");
    for (const auto& item : node.items) {
      std::string wrong;
      if (auto tag = files::read_text(item, wrong))
        add(*tag, item.place);
      else
        map.fail(item.place, "inputs: " + wrong, "expected is the tag of a stage");
    }
    return inputs;
  }

  void read_options(const YamlNode& node, StageSpec& spec) {
    if (node.kind == YamlNode::Kind::null) return;
    const StageType* type = stages_.find(spec.stage);
    if (!type) return;  // reported when the pipeline is built
    const files::YamlMap map(node, spec.tag.empty() ? spec.stage : spec.tag, errors_);
    stage::OptionAssignment options(*type, spec, folder_, errors_, plan_.warnings);
    for (const auto& entry : node.entries) {
      YamlNode value = entry.value;
      const std::size_t before = errors_.size();
      variables_.substitute(value, errors_);
      options.assign(entry.key, entry.place, value, errors_.size() == before);
    }
  }

  const fs::path& folder_;
  const PipelineArguments& arguments_;
  const StageRegistry& stages_;
  std::vector<Error>& errors_;
  stage::Settings settings_;
  stage::Variables variables_;
  stage::PipelinePlan plan_;
};

/// Errors of one file in the order of its lines; files in the order of their first error.
void sort_by_place(std::vector<Error>& errors) {
  std::vector<std::string> files;
  for (const auto& error : errors) {
    if (std::find(files.begin(), files.end(), error.place().file) == files.end()) {
      files.push_back(error.place().file);
    }
  }
  const auto key = [&](const Error& error) {
    const auto file = std::find(files.begin(), files.end(), error.place().file) - files.begin();
    return std::tuple(file, error.place().line, error.place().column);
  };
  std::stable_sort(errors.begin(), errors.end(),
                   [&](const Error& a, const Error& b) { return key(a) < key(b); });
}

/// File name extensions of the kind that stages read in a folder.
std::vector<std::string> endings_of_captures(const Registrar& registrar) {
  for (const auto& inspector : registrar.inspectors()) {
    if (inspector.kind == "a capture") return inspector.extensions;
  }
  return {};
}

}  // namespace

}  // namespace crisp

namespace crisp::stage {

PipelinePlan parse_plan(const YamlNode& root, const fs::path& folder, const PipelineArguments& arguments,
                        const StageRegistry& stages, std::vector<Error>& errors) {
  return PlanReader(folder, arguments, stages, errors).read(root);
}

LoadedPipeline load_pipeline(const YamlNode& root, const fs::path& file, const PipelineArguments& arguments,
                             RunSettings& run) {
  files::refuse_other_kinds(root, file, files::FileKind::pipeline);
  std::vector<Error> errors;
  const fs::path folder = fs::absolute(file).parent_path();
  PipelinePlan plan = parse_plan(root, folder, arguments, run.registrar->stages(), errors);
  run.rig = std::move(plan.rig);
  run.output = arguments.output ? fs::absolute(*arguments.output).lexically_normal() : fs::path();
  Pipeline pipeline = build_pipeline(plan.stages, run, errors, plan.rig_is_known);
  const fs::path output = arguments.only_validate && !arguments.output ? kNoOutput : run.output;
  const FilesOfRun own{.read = {file, plan.rig_file, arguments.input.value_or(fs::path())},
                       .summary = output.empty() ? fs::path() : output / kSummary,
                       .read_in_folders = endings_of_captures(*run.registrar)};
  check_files_written(pipeline, own, errors);
  pipeline.warnings.insert(pipeline.warnings.begin(), plan.warnings.begin(), plan.warnings.end());
  sort_by_place(errors);
  if (!errors.empty()) throw Errors(std::move(errors));
  return {std::move(pipeline), file, std::move(plan.rig_file)};
}

}  // namespace crisp::stage

namespace crisp {

LoadedPipeline load_pipeline(const fs::path& file, const PipelineArguments& arguments, RunSettings& run) {
  return stage::load_pipeline(files::read_yaml(file), file, arguments, run);
}

LoadedPipeline load_pipeline(std::string_view text, const fs::path& name, const PipelineArguments& arguments,
                             RunSettings& run) {
  return stage::load_pipeline(files::parse_yaml(text, name.string()), name, arguments, run);
}

}  // namespace crisp
