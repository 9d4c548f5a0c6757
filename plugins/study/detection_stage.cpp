// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/detection_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include <crisp/atomic_file.hpp>

namespace crisp::study {
namespace {

nlohmann::json effects_json(const EffectDetection& detection) {
  auto json = nlohmann::json::object();
  for (const diagnose::EffectResolution& effect : detection.effects) {
    auto& entry = json[effect.cause] = {{"unit", "m"}, {"confounded_with", effect.confounded_with}};
    if (std::isfinite(effect.detectable)) entry["detectable"] = effect.detectable;
    if (std::isfinite(effect.resolvable)) entry["resolvable"] = effect.resolvable;
  }
  return json;
}

}  // namespace

void DetectionStage::describe(StageDescription<DetectionStage>& d) {
  d.name("study.detection")
      .summary("computes from which size on a planned recording shows each effect, and resolves its cause");
  d.details(
      "For each effect of the catalogue, in its own formula: the size from which on diagnose.model would find it in such a recording (detectable), and the size from which on no other cause could stand in its place (resolvable), with the causes that could below that. Sizes are RMS changes of the ranges of the beams that the effect acts on, in the direction of its parameters that shows least. One recording is simulated. Fisher's information of all effects together with lambda, tau, alpha, eta and the planes of the surfaces that the diagnosis finds in it, and the thresholds of the stepwise selection, give the sizes.\n\n"
      "Compare motions, scenes and tilted rigs before recording. Noise counts as independent from beam to beam. Real surfaces are less flat and real errors are shared, so that real effects must be larger, on rough walls several times.");
  describe_planned(d, &DetectionStage::planned_);
  d.option("file", &DetectionStage::file_, "output file of the sizes, CSV").writes();
}

void DetectionStage::check(const RunSettings& run) const { planned_.check(run); }

void DetectionStage::process(const Inputs&, Outputs&, Context& context) {
  const PlannedRecording::Prepared planned = planned_.prepared(context);
  context.progress(0, "detection");
  detection_ =
      effect_detection(planned.scanner, planned.scene, planned.motion, simulate::known_terms(context.run()));
  context.report({{"scene", planned.scene.name},
                  {"beams", detection_.beams},
                  {"surfaces", detection_.surfaces},
                  {"effects", effects_json(detection_)}});
  context.print(fmt::format("{:g} s in the {}: tested with {} beams on {} flat surfaces; noise {:g} mm",
                            planned.scanner.duration, planned.scene.name, detection_.beams,
                            detection_.surfaces, planned.scanner.range.sigma * 1e3));
}

void DetectionStage::finish(Outputs&, Context& context) {
  context.print(effects_text(detection_));
  if (file_.empty()) return;
  write_file(file_, effects_csv(detection_));
  context.wrote(file_);
}

}  // namespace crisp::study
