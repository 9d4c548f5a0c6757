// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include <crisp/calibration_file.hpp>
#include <crisp/error.hpp>
#include <crisp/registrar.hpp>

#include "grabbers/simulate/found_effects.hpp"
#include "grabbers/simulate/paper.hpp"
#include "grabbers/simulate/real_devices.hpp"
#include "grabbers/simulate/scan_patterns.hpp"
#include "grabbers/simulate/scene_file.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/files/findings_file.hpp"
#include "pipeline/model/term_faults.hpp"

namespace crisp::simulate {
namespace {

void check_lasers(const Calibration& truth, const Rig& rig, const std::filesystem::path& file) {
  const bool same = std::equal(truth.lasers.begin(), truth.lasers.end(), rig.lasers.begin(), rig.lasers.end(),
                               [](const auto& a, const auto& b) { return a.name == b.name; });
  if (!same) {
    throw Error(file.string() + " is not a calibration of this rig",
                "it must name the rig's lasers, in the rig's order");
  }
}

}  // namespace

Scene SceneChoice::load(Context& context) const {
  if (file.empty()) return name == "paper" ? paper_room() : built_in_scene(name);
  context.reads(file);
  return read_scene(file);
}

Calibration TruthChoice::drawn(const RunSettings& run, std::uint64_t seed) const {
  return draw_truth(nominal_calibration(run.rig), nominal_errors, seed);
}

Calibration TruthChoice::load(Context& context, std::uint64_t seed) const {
  if (calibration_file.empty()) return drawn(context.run(), seed);
  Calibration truth = read_calibration(calibration_file, model::judge_by(known_terms(context.run())),
                                       [&](const Error& old) { context.warn(old.what()); });
  context.reads(calibration_file);
  check_lasers(truth, context.rig(), calibration_file);
  // Whatever it is of the scanner that it was made for, of the simulated one it is the truth.
  truth.caveats.clear();
  return truth;
}

void KindChoice::apply(ScannerSettings& scanner) const {
  scanner.patterns = read_patterns(lasers, scanner.rig, scanner.pattern_of_all());
}

std::vector<Effect> RealismChoice::load(const std::vector<EffectInfo>& catalogue, Context& context) const {
  std::vector<Effect> effects = effects_of_real_devices(devices, context.rig(), catalogue);
  if (findings_file.empty()) return effects;
  const Findings findings =
      files::read_findings(findings_file, [&](const Error& old) { context.warn(old.what()); });
  context.reads(findings_file);
  FoundEffects found = effects_of(findings, findings_file.string(), context.rig(), catalogue);
  if (!found.others.empty()) {
    context.print(fmt::format("findings that are not simulated: {}", fmt::join(found.others, ", ")));
  }
  context.report({{"findings_simulated", found.effects.size()}, {"findings_not_simulated", found.others}});
  std::ranges::move(found.effects, std::back_inserter(effects));
  return effects;
}

const TermRegistry& known_terms(const RunSettings& run) {
  static const TermRegistry none;
  return run.registrar ? run.registrar->get<TermRegistry>() : none;
}

}  // namespace crisp::simulate
