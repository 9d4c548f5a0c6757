// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/bound_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grabbers/simulate/device_effects.hpp"
#include "grabbers/simulate/world_options.hpp"
#include "pipeline/data/all_errors.hpp"
#include "pipeline/files/atomic_file.hpp"
#include "plugins/study/bound_text.hpp"
#include "plugins/study/parameter_kind.hpp"

namespace crisp {
namespace {

nlohmann::json parameters_json(const SceneBound& bound, const std::optional<Reached>& reached) {
  auto json = nlohmann::json::object();
  for (std::size_t k = 0; k < bound.parameters.size(); ++k) {
    const double error = bound.std_errors[static_cast<Eigen::Index>(k)];
    auto& entry = json[bound.parameters[k]] = {{"unit", kind_of(bound.parameters[k]).si}};
    if (std::isfinite(error)) {
      entry["std_error"] = error;
      entry["std_error_with_steps"] = bound.with_steps[static_cast<Eigen::Index>(k)];
    }
    if (!reached || !reached->failure.empty()) continue;
    const double claimed = reached->std_errors[static_cast<Eigen::Index>(k)];
    if (std::isfinite(claimed)) entry["refined_std_error"] = claimed;
  }
  return json;
}

nlohmann::json unobservable_json(const SceneBound& bound) {
  auto json = nlohmann::json::array();
  for (const Unobservable& u : bound.unobservable) {
    json.push_back({{"parameter", u.parameter}, {"reason", u.reason}, {"combination", u.combination}});
  }
  return json;
}

nlohmann::json planes_json(const SceneBound& bound, const Scene& scene) {
  auto json = nlohmann::json::array();
  for (std::size_t s = 0; s < scene.things(); ++s) {
    if (bound.beams_on[s] > 0) {
      json.push_back({{"surface", scene.name_of(s)}, {"beams", bound.beams_on[s]}});
    }
  }
  return json;
}

}  // namespace

void BoundStage::describe(StageDescription<BoundStage>& d) {
  d.name("study.bound").summary("says before a recording how well it would determine the parameters");
  d.details(
      "The Cramer-Rao bound: no unbiased calibration from such a recording has smaller standard errors, "
      "however it works. It is computed from the beams that the scanner would fire at the scene, with every "
      "surface of the scene as unknown as the parameters, three numbers each, and projected out. What the "
      "motion or the scene leave undetermined is named, with the combination that is known all the same: at "
      "constant speed each eta against the lambdas.\n\n"
      "Beside it stand the standard errors that calibrate.refine gives itself on one such recording with "
      "noise "
      "(`refine`): what the method reaches.\n\n"
      "The scanner is the run's rig, as it nominally is, or that of `calibration`. The plate's encoder and "
      "the clocks count as exact, and the effects of the model beyond lambda, tau, alpha and eta as known. "
      "A second figure counts the steps of the rig's encoder as well, as normal noise of the plate's "
      "angle.\n\n"
      "What is known before a recording, against which a parameter counts as determined, is what "
      "calibrate.refine takes for known: lambda and alpha to 0.05 rad, tau to 3 cm, eta to 10 ms.");
  describe_scene(d, &BoundStage::scene_);
  d.option("beams", &BoundStage::beams_,
           "those of the whole field of view, or the paper's two in the plate's plane")
      .choices({{"all", BeamChoice::kAll}, {"in_plane", BeamChoice::kInPlane}});
  d.option("duration", &BoundStage::scanner_, &ScannerSettings::duration,
           "how long to record; from some ten seconds on the errors fall with the root of it")
      .unit("s")
      .range(0.01, 100);
  d.option("noise", &BoundStage::scanner_, &ScannerSettings::range, &RangeSettings::sigma,
           "standard deviation of a range")
      .unit("m")
      .range(1e-6, 10);
  describe_motion(d, &BoundStage::motion);
  describe_truth(d, &BoundStage::truth_);
  describe_field(d, &BoundStage::scanner_);
  describe_kinds(d, &BoundStage::kinds_);
  d.option("refine", &BoundStage::refine_, "whether to try as well what calibrate.refine reaches");
  d.option("file", &BoundStage::file_, "where the bounds go, as CSV").writes();
}

std::vector<Effect> BoundStage::effects(const RunSettings& run) const {
  return read_effects(truth_.effects, run.rig, recording_catalogue(known_terms(run)));
}

void BoundStage::check(const RunSettings& run) const {
  check_all(
      [&] {
        Calibration truth = truth_.drawn(run, run.seed);
        add_terms(truth, effects(run), known_terms(run));
      },
      [&] { make_motion(scanner_.motion, scanner_.duration, run.seed); }, [&] { scanner_.field.beams(); },
      [&] {
        ScannerSettings planned = scanner_;
        planned.rig = run.rig;
        kinds_.apply(planned);
      });
}

void BoundStage::process(const Inputs&, Outputs&, Context& context) {
  ScannerSettings scanner = scanner_;
  scanner.rig = context.rig();
  kinds_.apply(scanner);
  scanner.seed = context.seed();
  scanner.truth = truth_.load(context, scanner.seed);
  add_terms(scanner.truth, effects(context.run()), known_terms(context.run()));
  const Scene scene = scene_.load(context);
  const Motion motion = make_motion(scanner.motion, scanner.duration, scanner.seed);
  const TermRegistry& terms = known_terms(context.run());
  context.progress(0, "bound");
  bound_ = scene_bound(scanner, scene, motion, beams_, terms);
  if (context.interrupted()) return;
  if (refine_) {
    context.progress(0.3, "calibrate.refine");
    reached_ = reached_by_refinement(scanner, scene, motion, beams_, bound_.parameters, terms);
  }
  tell(scene, context);
}

void BoundStage::tell(const Scene& scene, Context& context) const {
  context.report({{"scene", scene.name},
                  {"beams", bound_.beams},
                  {"no_echo", bound_.no_echo},
                  {"planes", planes_json(bound_, scene)},
                  {"parameters", parameters_json(bound_, reached_)},
                  {"unobservable", unobservable_json(bound_)}});
  const auto met = std::ranges::count_if(bound_.beams_on, [](std::size_t beams) { return beams > 0; });
  context.say(fmt::format("{:g} s in the {}: {} beams on {} surfaces, {} that meet nothing; noise {:g} mm",
                          scanner_.duration, scene.name, bound_.beams, met, bound_.no_echo,
                          scanner_.range.sigma * 1e3));
  if (!reached_ || !reached_->failure.empty()) return;
  context.report({{"refined_beams", reached_->beams}, {"refined_surfaces", reached_->surfaces}});
  context.say(fmt::format("calibrate.refine finds {} flat surfaces with {} of them", reached_->surfaces,
                          reached_->beams));
}

void BoundStage::finish(Outputs&, Context& context) {
  context.say(bound_text(bound_, reached_));
  if (file_.empty()) return;
  write_file(file_, bound_csv(bound_, reached_));
  context.wrote(file_);
}

}  // namespace crisp
