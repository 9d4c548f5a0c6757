// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/bound_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <crisp/atomic_file.hpp>

#include "plugins/study/bound_text.hpp"
#include "plugins/study/parameter_kind.hpp"

namespace crisp::study {
namespace {

nlohmann::json parameters_json(const SceneBound& bound, const std::optional<RefinementAccuracy>& refinement) {
  auto json = nlohmann::json::object();
  for (std::size_t k = 0; k < bound.parameters.size(); ++k) {
    const double error = bound.std_errors[static_cast<Eigen::Index>(k)];
    auto& entry = json[bound.parameters[k]] = {{"unit", kind_of(bound.parameters[k]).si}};
    if (std::isfinite(error)) {
      entry["std_error"] = error;
      entry["std_error_with_steps"] = bound.with_steps[static_cast<Eigen::Index>(k)];
    }
    if (!refinement || !refinement->failure.empty()) continue;
    const double estimated = refinement->std_errors[static_cast<Eigen::Index>(k)];
    if (std::isfinite(estimated)) entry["refined_std_error"] = estimated;
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

nlohmann::json planes_json(const SceneBound& bound, const simulate::Scene& scene) {
  auto json = nlohmann::json::array();
  for (std::size_t s = 0; s < scene.things(); ++s) {
    if (bound.beams_on[s] > 0) {
      json.push_back({{"surface", scene.name_of(s)}, {"beams", bound.beams_on[s]}});
    }
  }
  return json;
}

/// Lasers that the rig has on the spin axis, moved off it, with their names. At τ = 0 alone λ and α are one
/// parameter, and no mounting is as exact.
std::vector<std::string> moved_off_the_axis(Calibration& truth) {
  constexpr double kOff = 0.003;  // [m]
  std::vector<std::string> names;
  for (LaserCalibration& laser : truth.lasers) {
    if (std::abs(laser.tau.value) >= kOff) continue;
    laser.tau.value = std::copysign(kOff, laser.tau.value);
    names.push_back(laser.name);
  }
  return names;
}

}  // namespace

void BoundStage::describe(StageDescription<BoundStage>& d) {
  d.name("study.bound").summary("computes the Cramer-Rao bound of the parameters for a planned recording");
  d.details(
      "The Cramer-Rao bound: the least standard errors of any unbiased calibration from such a recording. It is computed from the beams that the scanner would fire at the scene, with every surface of the scene as unknown as the parameters, three numbers each, and projected out. Parameters that the motion or the scene leave undetermined are named, with the combination that is determined: at constant speed each eta against the lambdas.\n\n"
      "For comparison, `refine` adds the standard errors that calibrate.refine estimates on one such recording with noise.\n\n"
      "The scanner has the rig's nominal values, or those of `calibration`; a laser nearer than 3 mm to the spin axis, where lambda and alpha merge, counts as 3 mm from it. The plate's encoder and the clocks count as exact, and the effects of the model beyond lambda, tau, alpha and eta as known. A second bound counts the steps of the rig's encoder as well, as normal noise of the plate's angle.\n\n"
      "A parameter counts as determined against the prior of calibrate.refine: lambda and alpha to 0.05 rad, tau to 3 cm, eta to 10 ms.");
  describe_planned(d, &BoundStage::planned_);
  d.option("beams", &BoundStage::beams_,
           "beams used: the whole field of view, or the paper's two in the plate's plane")
      .choices({{"all", BeamChoice::kAll}, {"in_plane", BeamChoice::kInPlane}});
  d.option("refine", &BoundStage::refine_,
           "whether to add the standard errors of calibrate.refine on a simulated recording");
  d.option("file", &BoundStage::file_, "output file of the bounds, CSV").writes();
}

void BoundStage::check(const RunSettings& run) const { planned_.check(run); }

void BoundStage::process(const Inputs&, Outputs&, Context& context) {
  PlannedRecording::Prepared planned = planned_.prepared(context);
  if (planned_.truth.calibration_file.empty()) {
    for (const auto& name : moved_off_the_axis(planned.scanner.truth))
      context.print(name + ": on the spin axis by the rig, and computed for a tau of 3 mm");
  }
  const auto& [scanner, scene, motion] = planned;
  const TermRegistry& terms = simulate::known_terms(context.run());
  context.progress(0, "bound");
  bound_ = scene_bound(scanner, scene, motion, beams_, terms);
  if (context.interrupted()) return;
  if (refine_) {
    context.progress(0.3, "calibrate.refine");
    refinement_ = refinement_accuracy(scanner, scene, motion, beams_, bound_.parameters, terms);
  }
  report(planned, context);
}

void BoundStage::report(const PlannedRecording::Prepared& planned, Context& context) const {
  const simulate::Scene& scene = planned.scene;
  context.report({{"scene", scene.name},
                  {"beams", bound_.beams},
                  {"no_echo", bound_.no_echo},
                  {"planes", planes_json(bound_, scene)},
                  {"parameters", parameters_json(bound_, refinement_)},
                  {"unobservable", unobservable_json(bound_)}});
  const auto hit = std::ranges::count_if(bound_.beams_on, [](std::size_t beams) { return beams > 0; });
  context.print(fmt::format("{:g} s in the {}: {} beams on {} surfaces, {} without echo; noise {:g} mm",
                            planned.scanner.duration, scene.name, bound_.beams, hit, bound_.no_echo,
                            planned.scanner.range.sigma * 1e3));
  if (!refinement_ || !refinement_->failure.empty()) return;
  context.report({{"refined_beams", refinement_->beams}, {"refined_surfaces", refinement_->surfaces}});
  context.print(fmt::format("calibrate.refine finds {} flat surfaces with {} of them", refinement_->surfaces,
                            refinement_->beams));
}

void BoundStage::finish(Outputs&, Context& context) {
  context.print(bound_text(bound_, refinement_));
  if (file_.empty()) return;
  write_file(file_, bound_csv(bound_, refinement_));
  context.wrote(file_);
}

}  // namespace crisp::study
