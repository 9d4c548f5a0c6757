// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include <crisp/atomic_file.hpp>
#include <crisp/effect_catalogue.hpp>
#include <crisp/rig_file.hpp>

#include "pipeline/app/effect_reference.hpp"
#include "pipeline/data/counted.hpp"
#include "pipeline/files/file_kind.hpp"
#include "pipeline/files/folder_lock.hpp"
#include "pipeline/files/json_text.hpp"
#include "pipeline/files/nearest.hpp"
#include "pipeline/files/renamed_names.hpp"
#include "pipeline/files/rig_yaml.hpp"
#include "pipeline/stage/pipeline_plan.hpp"
#include "pipeline/stage/reference.hpp"
#include "pipeline/stage/unknown_names.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;

std::string_view family_of(const StageType& type) {
  return std::string_view(type.name).substr(0, type.name.find('.'));
}

/// @param wanted  the family to list; empty: all
/// @return whether there was any
bool print_stage_list(const StageRegistry& stages, std::string_view requested) {
  std::string_view before;
  for (const auto* type : stages.all()) {
    const std::string_view family = family_of(*type);
    if (!requested.empty() && family != requested) continue;
    if (!before.empty() && family != before) std::cout << "\n";
    before = family;
    std::cout << fmt::format("{:<26}{}\n", type->name, type->summary);
  }
  return !before.empty();
}

ExitStatus write_reference(const StageRegistry& stages, const fs::path& folder) try {
  const files::FolderLock lock(folder);
  for (const auto* type : stages.all())
    write_file(folder / (type->name + ".md"), stage::stage_markdown(*type));
  write_file(folder / "README.md", stage::index_markdown(stages));
  return ExitStatus::done;
} catch (const Error& error) {
  print_errors(error);
  return ExitStatus::misused;
}

/// A stage, or a family of them.
ExitStatus print_named(const StagesRequest& request, const StageRegistry& stages) {
  const StageType* type = stages.find(files::current_name(files::RenamedName::Kind::stage, "", request.name));
  if (!type && print_stage_list(stages, request.name)) return ExitStatus::done;
  if (!type) {
    print_errors(stage::no_such_stage(request.name, stages));
    return ExitStatus::misused;
  }
  std::cout << (request.markdown ? stage::stage_markdown(*type) : stage::stage_text(*type));
  return ExitStatus::done;
}

void validate_rig(const files::YamlNode& root, const fs::path& file, const PipelineArguments& arguments) {
  if (arguments.rig || !arguments.set.empty())
    throw Error(file.string() + " is a rig", "--rig and --set are for pipelines");
  const Rig rig = files::parse_rig(root);
  std::cout << fmt::format("{}: valid, a rig of {}\n", file.string(),
                           data::counted(rig.lasers.size(), "laser"));
}

}  // namespace

std::string error_text(const Error& error) {
  const auto* several = dynamic_cast<const Errors*>(&error);
  if (!several) return (to_string(error.place()).empty() ? "error: " : "") + std::string(error.what());
  std::string text;
  for (const auto& one : several->all()) text += (text.empty() ? "" : "\n") + error_text(one);
  if (several->all().size() > 1) text += "\n" + std::to_string(several->all().size()) + " errors";
  return text;
}

void print_errors(const Error& error) { std::cerr << error_text(error) << "\n"; }

void print_warnings(const Pipeline& pipeline) {
  for (const auto& warning : pipeline.warnings) {
    std::cerr << to_string(warning.place) << ": warning: " << warning.text << "\n";
  }
}

ExitStatus validate_command(const fs::path& file, PipelineArguments arguments, const Registrar& registrar) {
  RunSettings run;
  run.registrar = &registrar;
  arguments.only_validate = true;
  try {
    const files::YamlNode root = files::read_yaml(file);
    if (files::kind_of(root) == files::FileKind::rig) {
      validate_rig(root, file, arguments);
      return ExitStatus::done;
    }
    const auto loaded = stage::load_pipeline(root, file, arguments, run);
    print_warnings(loaded.pipeline);
    std::cout << fmt::format("{}: valid, {}\n", file.string(),
                             data::counted(loaded.pipeline.nodes.size(), "stage"));
  } catch (const Error& error) {
    print_errors(error);
    return ExitStatus::misused;
  }
  return ExitStatus::done;
}

ExitStatus stages_command(const StagesRequest& request, const Registrar& registrar) {
  const StageRegistry& stages = registrar.stages();
  if (request.json_schema) {
    std::cout << files::json_text(stage::pipeline_schema(stages), 2) << "\n";
  } else if (!request.name.empty()) {
    return print_named(request, stages);
  } else if (request.names) {
    for (const auto& name : stages.names()) std::cout << name << "\n";
  } else if (request.markdown && request.output) {
    return write_reference(stages, *request.output);
  } else if (request.markdown) {
    std::cout << stage::index_markdown(stages);
    for (const auto* type : stages.all()) std::cout << "\n" << stage::stage_markdown(*type);
  } else {
    print_stage_list(stages, {});
  }
  return ExitStatus::done;
}

ExitStatus effects_command(const EffectsRequest& request, const Registrar& registrar) {
  const auto catalogue = effect_catalogue(registrar.get<TermRegistry>());
  if (!request.name.empty()) {
    const auto effect = std::ranges::find(catalogue, request.name, &EffectInfo::name);
    if (effect == catalogue.end()) {
      std::vector<std::string> names;
      for (const auto& known : catalogue) names.push_back(known.name);
      print_errors(Error("there is no effect '" + request.name + "'",
                         files::did_you_mean(request.name, names, "crisp effects lists them")));
      return ExitStatus::misused;
    }
    std::cout << effect_text(*effect);
  } else if (request.markdown) {
    std::cout << effects_markdown(catalogue);
  } else {
    for (const auto& effect : catalogue) {
      std::cout << (request.names ? effect.name : fmt::format("{:<42}{}", effect.name, effect.summary))
                << "\n";
    }
  }
  return ExitStatus::done;
}

void list_plugins(const PluginLoader& loader) {
  if (loader.tried().empty()) std::cout << "no plugins: name them with --plugin, or in CRISP_PLUGINS\n";
  for (const auto& plugin : loader.tried()) {
    std::cout << plugin.file.string() << "\n";
    if (!plugin.refusal.empty()) {
      std::cout << fmt::format("  refused: {}\n", plugin.refusal);
      continue;
    }
    std::cout << fmt::format("  {} {}\n", plugin.name, plugin.version);
    if (!plugin.skipped.empty())
      std::cout << fmt::format("  skipped: already loaded from {}\n", plugin.skipped);
    if (!plugin.warning.empty()) std::cout << fmt::format("  warning: {}\n", plugin.warning);
    for (const auto& what : plugin.brings) std::cout << fmt::format("  {}\n", what);
  }
}

}  // namespace crisp::app
