// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/unknown_names.hpp"

#include <string_view>
#include <vector>

#include "pipeline/files/nearest.hpp"

namespace crisp::stage {
namespace {

/// The stages of whose names `fits` likes the part behind the dot: 'did you mean' them; empty if there is
/// none.
template <class Fits>
std::string meant_by_last_part(const StageRegistry& stages, Fits fits) {
  std::string meant;
  for (const auto& known : stages.names()) {
    if (!fits(std::string_view(known).substr(known.find('.') + 1))) continue;
    meant += (meant.empty() ? "did you mean '" : " or '") + known + "'";
  }
  return meant.empty() ? meant : meant + "?";
}

/// The same for a name without a family: "crop" for filter.crop, "voxelgrid" for filter.voxel.
std::string meant_without_family(std::string_view name, const StageRegistry& stages) {
  constexpr std::size_t kDistinctive = 4;  // letters that two names do not share by chance
  if (name.find('.') != std::string_view::npos) return {};
  auto meant = meant_by_last_part(stages, [name](std::string_view last) { return last == name; });
  if (!meant.empty()) return meant;
  return meant_by_last_part(stages, [name](std::string_view last) {
    return last.size() >= kDistinctive && name.starts_with(last);
  });
}

}  // namespace

Error no_such_stage(const std::string& name, const StageRegistry& stages) {
  auto meant = meant_without_family(name, stages);
  if (meant.empty()) meant = files::did_you_mean(name, stages.names(), "crisp stages lists them;");
  return Error("there is no stage '" + name + "'", meant + " load a plugin's with --plugin FILE");
}

std::string no_such_option(const StageType& type, const std::string& name) {
  std::vector<std::string> known;
  for (const auto& option : type.options) known.push_back(option.name);
  return files::did_you_mean(name, known,
                             known.empty() ? "it has none" : "crisp stages " + type.name + " lists them");
}

std::string accept_old_name(files::RenamedName::Kind kind, std::string_view owner, const std::string& name,
                            const Place& place, std::vector<PipelineWarning>& warnings) {
  std::string today = files::current_name(kind, owner, name);
  if (today != name) warnings.push_back({files::old_name_warning(name, today).what(), place});
  return today;
}

}  // namespace crisp::stage
