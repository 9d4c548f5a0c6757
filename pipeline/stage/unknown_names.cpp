// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/unknown_names.hpp"

#include <algorithm>
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

/// "delay" of "links.laser.delay".
std::string last_part(const std::string& name) { return name.substr(name.rfind('.') + 1); }

}  // namespace

Error no_such_stage(const std::string& name, const StageRegistry& stages) {
  auto meant = meant_without_family(name, stages);
  if (meant.empty()) meant = files::did_you_mean(name, stages.names(), "crisp stages lists them;");
  return Error("there is no stage '" + name + "'", meant + " load a plugin's with --plugin FILE");
}

std::string no_such_option(const StageType& type, const std::string& name) {
  if (type.options.empty()) return "it has none";
  std::vector<std::string> known;
  std::vector<std::string> last_parts;
  for (const auto& option : type.options) {
    known.push_back(option.name);
    last_parts.push_back(last_part(option.name));
  }
  for (const auto& [group, help] : type.groups) known.push_back(group);
  std::string meant = files::did_you_mean(name, known, {});
  if (!meant.empty()) return meant;
  const auto near = files::nearest_name(last_part(name), last_parts);  // without its group, or in another
  if (!near) return "crisp stages " + type.name + " lists them";
  const auto at = std::ranges::find(last_parts, *near) - last_parts.begin();
  return "did you mean '" + known[static_cast<std::size_t>(at)] + "'?";
}

std::string accept_old_name(files::RenamedName::Kind kind, std::string_view owner, const std::string& name,
                            const Place& place, std::vector<PipelineWarning>& warnings) {
  std::string today = files::current_name(kind, owner, name);
  if (today != name) warnings.push_back({files::old_name_warning(name, today).what(), place});
  return today;
}

}  // namespace crisp::stage
