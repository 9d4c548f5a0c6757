// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/detection_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include <crisp/all_errors.hpp>
#include <crisp/atomic_file.hpp>

#include "grabbers/simulate/device_effects.hpp"
#include "grabbers/simulate/scenario_options.hpp"

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
  simulate::describe_scene(d, &DetectionStage::scene_);
  d.option("duration", &DetectionStage::scanner_, &simulate::ScannerSettings::duration,
           "duration of the recording")
      .unit("s")
      .range(0.01, 100);
  d.option("noise", &DetectionStage::scanner_, &simulate::ScannerSettings::range,
           &simulate::RangeSettings::sigma, "standard deviation of a range")
      .unit("m")
      .range(1e-6, 10);
  simulate::describe_motion(d, &DetectionStage::motion);
  simulate::describe_truth(d, &DetectionStage::truth_);
  simulate::describe_field(d, &DetectionStage::scanner_);
  simulate::describe_kinds(d, &DetectionStage::kinds_);
  d.option("file", &DetectionStage::file_, "output file of the sizes, CSV").writes();
}

void DetectionStage::check(const RunSettings& run) const {
  check_all(
      [&] {
        Calibration truth = truth_.drawn(run, run.seed);
        simulate::add_terms(truth,
                            simulate::read_effects(truth_.effects, run.rig,
                                                   simulate::recording_catalogue(simulate::known_terms(run))),
                            simulate::known_terms(run));
      },
      [&] { simulate::make_motion(scanner_.motion, scanner_.duration, run.seed); },
      [&] { scanner_.field.beams(); },
      [&] {
        simulate::ScannerSettings planned = scanner_;
        planned.rig = run.rig;
        kinds_.apply(planned);
      });
}

void DetectionStage::process(const Inputs&, Outputs&, Context& context) {
  const TermRegistry& terms = simulate::known_terms(context.run());
  simulate::ScannerSettings scanner = scanner_;
  scanner.rig = context.rig();
  kinds_.apply(scanner);
  scanner.seed = context.seed();
  scanner.truth = truth_.load(context, scanner.seed);
  simulate::add_terms(
      scanner.truth,
      simulate::read_effects(truth_.effects, context.rig(), simulate::recording_catalogue(terms)), terms);
  const simulate::Scene scene = scene_.load(context);
  context.progress(0, "detection");
  detection_ = effect_detection(scanner, scene,
                                simulate::make_motion(scanner.motion, scanner.duration, scanner.seed), terms);
  context.report({{"scene", scene.name},
                  {"beams", detection_.beams},
                  {"surfaces", detection_.surfaces},
                  {"effects", effects_json(detection_)}});
  context.print(fmt::format("{:g} s in the {}: tested with {} beams on {} flat surfaces; noise {:g} mm",
                            scanner_.duration, scene.name, detection_.beams, detection_.surfaces,
                            scanner_.range.sigma * 1e3));
}

void DetectionStage::finish(Outputs&, Context& context) {
  context.print(effects_text(detection_));
  if (file_.empty()) return;
  write_file(file_, effects_csv(detection_));
  context.wrote(file_);
}

}  // namespace crisp::study
