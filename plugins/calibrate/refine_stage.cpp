// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/refine_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/data/all_errors.hpp"
#include "pipeline/data/recordings.hpp"
#include "pipeline/estimate/clock_errors.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/recording_lags.hpp"
#include "pipeline/estimate/wanted_terms.hpp"
#include "pipeline/stage/option_check.hpp"
#include "pipeline/stage/registry.hpp"
#include "plugins/calibrate/fit_check.hpp"
#include "plugins/calibrate/report.hpp"
#include "plugins/calibrate/rig_check.hpp"
#include "plugins/calibrate/rig_hypotheses.hpp"
#include "plugins/calibrate/single_beams.hpp"

namespace crisp {
void RefineStage::describe(StageDescription<RefineStage>& d) {
  d.name("calibrate.refine").summary("refines a calibration by the flat surfaces that all beams show");
  d.details(
      "Weighted least squares in the distances of all beams to the surfaces that they meet, with the "
      "surfaces' planes as unknowns. It has none of the bias of an entropy's optimum and a tenth of its "
      "scatter, but needs a start that is right to some centimetres: calibrate.rqe, or calibrate.load. What "
      "the data do not determine stays as it came.\n\n"
      "Where the clocks' own errors are known (clock.convex_hull), they are part of those of eta.\n\n"
      "Several recordings (what pauses of 5 s divide) may have been made in several places: no surface is "
      "looked for in more than one of them, and each has lags of its own, of which the mean is eta.\n\n"
      "If all beams lie in the plate's plane (two of each laser), the walls that they meet are taken to be "
      "upright.");
  d.takes<Measurements>().takes<ClockMap>(Need::optional);
  d.holds<PlateTrajectory>().holds<Calibration>().gives<Calibration>();
  d.option("noise", &RefineStage::settings_, &RefinementSettings::surfels, &SurfelSettings::noise,
           "standard deviation of a range")
      .unit("m")
      .range(1e-6, 1);
  d.option("smallest", &RefineStage::settings_, &RefinementSettings::surfels, &SurfelSettings::smallest,
           "side of the smallest flat patch that counts")
      .unit("m")
      .range(0.01, 10);
  d.option("largest", &RefineStage::settings_, &RefinementSettings::surfels, &SurfelSettings::largest,
           "side of the patches that are tried first")
      .unit("m")
      .range(0.01, 100);
  d.option("fixed", &RefineStage::settings_, &RefinementSettings::fixed,
           "parameters that are left as they are: laser1.eta, or eta for that of all lasers");
  d.option("terms", &RefineStage::settings_, &RefinementSettings::terms,
           "effects to be found as well, where they are terms of the sensor model: encoder.eccentricity, or "
           "laser2.mirror.cone of one laser; `crisp effects` lists them");
  d.option("rounds", &RefineStage::settings_, &RefinementSettings::max_rounds, "most steps that are taken")
      .range(1, 1000);
  d.option("sigma", &RefineStage::sigma_, "kernel width of the RQE that judges the result")
      .unit("m")
      .range(1e-3, 10);
}

void RefineStage::check(const RunSettings& run) const {
  Calibration nominal = nominal_calibration(run.rig);
  check_all(of_option("largest",
                      [&] {
                        if (settings_.surfels.largest >= settings_.surfels.smallest) return;
                        throw Error("the largest patch is smaller than the smallest",
                                    "give a `largest` above `smallest`");
                      }),
            of_option("fixed", [&] { check_fixed(settings_.fixed, nominal); }), of_option("terms", [&] {
              add_wanted_terms(nominal, settings_.terms, run.registrar->get<TermRegistry>());
            }));
}

void RefineStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const auto* clock = in.find<ClockMap>()) clocks_.insert_or_assign(clock->device, *clock);
  if (!in.find<Measurements>()) return;
  start_ = in.share<Calibration>();
  collected_.add(in.share<Measurements>(),
                 oriented_(in.share<PlateTrajectory>(), start_.get(), context.rig()));
}

void RefineStage::finish(Outputs& out, Context& context) {
  Sample sample = collected_.sample();
  context.count("beams left out of the calibration of a long recording", collected_.left_out());
  const auto& terms = context.run().registrar->get<TermRegistry>();
  settings_.prior.nominal = nominal_values(context.rig());
  settings_.angle_step = std::abs(context.rig().plate.angle_per_count());
  settings_.angle_error = plate_angle_error(*sample.plate, context.rig(), clocks_);
  refuse_single_beams(sample.beams, *start_, settings_.fixed);
  Calibration with_terms = *start_;
  add_wanted_terms(with_terms, settings_.terms, terms);
  const SensorModel start(with_terms, terms);
  const auto report = [&](int round) {
    context.progress(static_cast<double>(round) / (round + 4), fmt::format("round {}", round + 1));
    return !context.interrupted();
  };
  Refinement refined = refine_by_surfels(start, sample, settings_, report);
  if (RecordingNumbers(*sample.plate).count() > 1 && !context.interrupted()) {
    const RecordingLags lags = lags_of_recordings(refined.outcome.model, sample, settings_);
    tell(lags, *sample.plate, context);
    sample = with_common_lags(std::move(sample), lags);
    refined = refine_by_surfels(start, sample, settings_, report);
  }
  if (context.interrupted()) return;

  const auto halves =
      cross_validate(refined.outcome.model, sample, settings_, [&](int) { return !context.interrupted(); });
  if (context.interrupted()) return;
  add_clock_errors(refined.outcome, context.rig(), clocks_);
  Calibration calibration = calibration_of(refined.outcome, context.rig());
  // calibrate.rqe decides by values that may be some centimetres off.
  if (auto turned =
          in_direction_of_rig(calibration, context.rig(), check_with_rig(calibration, context.rig(), {}))) {
    context.warn(kCountsClockwise);
    calibration = std::move(*turned);
  }
  judge(sample, refined, calibration, context);
  if (context.interrupted()) return;
  tell(halves, context);
  if (halves) calibration.quality["cross_validation"] = halves->ratio();
  calibration.provenance = start_->provenance;
  calibration.provenance["refinement"] = "calibrate.refine";
  tell(calibration, *start_, context);
  out.give(std::move(calibration));
}

std::vector<std::string> RefineStage::mistakes(const Sample& sample, const Refinement& refined, bool fits,
                                               Measure& measure, Context& context) const {
  if (is_in_plane(sample)) return {};
  const HypothesisSettings settings{
      .terms = &context.run().registrar->get<TermRegistry>(),
      .measure = &measure,
      .refinement = settings_,
      .interrupted = [&] { return context.interrupted(); },
      .report = [&](double done, std::string_view what) { context.progress(done, what); }};
  auto found = check_mounts(refined.outcome.model, sample, context.rig(), settings);
  if (fits || agrees_well(refined) || !found.empty()) return found;
  if (auto mistake = find_rig_error(sample, context.rig(), settings)) found.push_back(std::move(*mistake));
  return found;
}

void RefineStage::judge(const Sample& sample, const Refinement& refined, Calibration& calibration,
                        Context& context) const {
  const auto& registrar = *context.run().registrar;
  const auto& terms = registrar.get<TermRegistry>();
  const auto measure =
      registrar.get<MeasureRegistry>().make("rqe", MeasureSettings{}, registrar.get<SearchRegistry>());
  const auto crispness =
      crispness_of({refined.outcome.model, SensorModel(nominal_calibration(context.rig()), terms),
                    SensorModel(*start_, terms)},
                   longest_recording(sample), {.sigma = sigma_}, *measure);
  calibration.quality = {{"rqe_before", crispness[1]},
                         {"rqe_unrefined", crispness[2]},
                         {"rqe_after", crispness[0]},
                         {"rqe_sigma", sigma_},
                         {"chi2", refined.chi2}};
  context.report({{"surfels", refined.surfels},
                  {"beams", refined.beams},
                  {"chi2", refined.chi2},
                  {"rounds", refined.rounds},
                  {"converged", refined.converged}});
  context.say(fmt::format("{} flat surfaces with {} beams; chi2 {:.3f} per degree of freedom after {} rounds",
                          refined.surfels, refined.beams, refined.chi2, refined.rounds));
  tell(refined.views, context);
  for (const auto& name : known_from_rig_only(calibration, settings_.prior)) {
    context.say(name + ": known from the rig only; these data do not determine it better");
  }
  const double noise = settings_.surfels.noise;
  context.report({{"misfit", misfit_of(refined, noise)}, {"neighbour_noise", refined.scatter}});
  const auto of_fit = check_fit(refined, calibration, *start_, context.rig(), noise);
  const auto of_rig = mistakes(sample, refined, of_fit.empty(), *measure, context);
  for (const auto& mistake : of_rig) context.distrust(mistake);
  // A mistake that is known by name explains the rest, which nobody needs to look into before it is mended.
  for (const auto& caveat : of_fit) {
    if (of_rig.empty())
      context.distrust(caveat);
    else
      context.say("probably for that reason: " + caveat);
  }
  if (of_rig.empty() && of_fit.empty() && start_->doubts.empty()) {
    context.lift_doubts(KindName<Calibration>::value,
                        "the refined calibration fits, and agrees with the rig");
  }
}

}  // namespace crisp
