// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/refine_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <crisp/error.hpp>
#include <crisp/registrar.hpp>

#include "pipeline/data/recordings.hpp"
#include "pipeline/estimate/clock_errors.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/recording_lags.hpp"
#include "pipeline/estimate/requested_terms.hpp"
#include "plugins/calibrate/fit_check.hpp"
#include "plugins/calibrate/refinement_restart.hpp"
#include "plugins/calibrate/report.hpp"
#include "plugins/calibrate/rig_check.hpp"
#include "plugins/calibrate/rig_hypotheses.hpp"
#include "plugins/calibrate/single_beam_refusal.hpp"

namespace crisp::calibrate {
namespace {

using estimate::Refinement;
using estimate::RefinementSettings;

/// Whether the scene may be folded onto few flat surfaces, on which a wrong mount makes no views differ:
/// neither different lasers nor the halves of a sweep see the same, as with one laser that sees one side.
bool may_be_folded(const Refinement& refined, const estimate::Sample& sample) {
  const auto beams = static_cast<double>(sample.beams.size());
  return static_cast<double>(refined.beams) < kOrdinaryShare * beams &&
         std::ranges::all_of(refined.views, &estimate::ViewConsistency::is_by_time);
}

/// Whether the refined values answer all caveats of the calibration that they started from.
bool are_resolved(const std::vector<std::string>& caveats, const RigCheck& refined) {
  return std::ranges::all_of(caveats, [&](const std::string& caveat) {
    return caveat == kDirectionIsOpen && refined.knows_direction;
  });
}

}  // namespace

void RefineStage::describe(StageDescription<RefineStage>& d) {
  d.name("calibrate.refine").summary("refines a calibration by least squares against flat surfaces");
  d.details(
      "Weighted least squares in the distances of all beams from their flat surfaces (surfels), with the surfaces' planes as unknowns. Unlike the optimum of an entropy it is unbiased, with a tenth of the scatter, but it needs a start within some centimetres: calibrate.rqe, or calibrate.load. If its views disagree, it is repeated from the rig's nominal values, then with one laser added after the other, and the first result that fits is taken. Unobservable parameters stay at the start's values.\n\n"
      "The clocks' standard errors, where they are known (clock.convex_hull), are part of those of eta.\n\n"
      "Several recordings (separated by pauses of 5 s) may be of different places: surfaces are segmented in each by itself, and each has lags of its own, whose mean is eta.\n\n"
      "If all beams lie in the plate's plane (two of each laser), the walls are assumed to be upright.");
  d.takes<Measurements>().takes<ClockMap>(Need::optional);
  d.holds<PlateTrajectory>().holds<Calibration>().gives<Calibration>();
  d.option("noise", &RefineStage::settings_, &RefinementSettings::surfels, &quality::SurfelSettings::noise,
           "standard deviation of a range's noise")
      .unit("m")
      .range(1e-6, 1);
  d.option("min_cell", &RefineStage::settings_, &RefinementSettings::surfels,
           &quality::SurfelSettings::smallest,
           "side of the smallest flat patch; reduce it for small surfaces with many beams")
      .unit("m")
      .range(0.01, 10);
  d.option("max_cell", &RefineStage::settings_, &RefinementSettings::surfels,
           &quality::SurfelSettings::largest,
           "side of the first patches of the coarse-to-fine search for flat surfaces")
      .unit("m")
      .range(0.01, 100);
  d.option("fixed", &RefineStage::settings_, &RefinementSettings::fixed,
           "parameters that are held: laser1.eta, or eta for that of all lasers");
  d.option(
      "terms", &RefineStage::settings_, &RefinementSettings::terms,
      "further terms of the sensor model to estimate: encoder.eccentricity, or laser2.mirror.cone of one laser; `crisp effects` lists them");
  d.option("rounds", &RefineStage::settings_, &RefinementSettings::max_rounds,
           "maximum number of Gauss-Newton steps")
      .range(1, 1000);
  d.option("sigma", &RefineStage::sigma_, "kernel width of the RQE that is reported before and after")
      .unit("m")
      .range(1e-3, 10);
}

void RefineStage::check(const RunSettings& run) const {
  Calibration nominal = nominal_calibration(run.rig);
  check_all(of_option("max_cell",
                      [&] {
                        if (settings_.surfels.largest >= settings_.surfels.smallest) return;
                        throw Error("the largest patch is smaller than the smallest",
                                    "give a `max_cell` above `min_cell`");
                      }),
            of_option("fixed", [&] { estimate::check_fixed(settings_.fixed, nominal); }),
            of_option("terms", [&] {
              estimate::add_requested_terms(nominal, settings_.terms, run.registrar->get<TermRegistry>());
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
  estimate::Sample sample = collected_.sample();
  context.count("beams left out of the calibration of a long recording", collected_.left_out());
  const auto& terms = context.run().registrar->get<TermRegistry>();
  settings_.prior.nominal = estimate::nominal_values(context.rig());
  settings_.angle_step = std::abs(context.rig().plate.angle_per_count());
  settings_.angle_error = estimate::plate_angle_error(*sample.plate, context.rig(), clocks_);
  refuse_single_beams(sample.beams, *start_, settings_.fixed);
  Calibration with_terms = *start_;
  estimate::add_requested_terms(with_terms, settings_.terms, terms);
  const SensorModel start(with_terms, terms);
  const estimate::RoundReporter on_round = rounds_of(context);
  Refinement refined = estimate::refine_by_surfels(start, sample, settings_, on_round);
  if (data::RecordingNumbers(*sample.plate).count() > 1 && !context.interrupted()) {
    const estimate::RecordingLags lags =
        estimate::lags_of_recordings(refined.outcome.model, sample, settings_);
    report(lags, *sample.plate, context);
    sample = estimate::with_common_lags(std::move(sample), lags);
    refined = estimate::refine_by_surfels(start, sample, settings_, on_round);
  }
  if (auto better = refined_from_another_start(refined, sample, *start_, settings_, context))
    refined = std::move(*better);
  if (context.interrupted()) return;

  const auto halves = estimate::cross_validate(
      refined.outcome.model, sample, settings_, [&](int) { return !context.interrupted(); },
      refined.surfaces);
  if (context.interrupted()) return;
  estimate::add_clock_errors(refined.outcome, context.rig(), clocks_);
  Calibration calibration = estimate::calibration_of(refined.outcome, context.rig());
  // calibrate.rqe decides by values that may be some centimetres off.
  if (auto turned =
          in_direction_of_rig(calibration, context.rig(), check_with_rig(calibration, context.rig(), {}))) {
    context.warn(kCountsClockwise);
    calibration = std::move(*turned);
  }
  calibration.provenance = start_->provenance;
  calibration.provenance["refinement"] = "calibrate.refine";
  judge(sample, refined, calibration, context);
  if (context.interrupted()) return;
  report(halves, context);
  if (halves) calibration.quality["cross_validation"] = halves->ratio();
  report(calibration, *start_, context);
  out.give(std::move(calibration));
}

std::vector<std::string> RefineStage::mistakes(const estimate::Sample& sample, const Refinement& refined,
                                               const RigCheck& check, Measure& measure,
                                               Context& context) const {
  if (estimate::is_in_plane(sample)) return {};
  const HypothesisSettings settings{
      .terms = &context.run().registrar->get<TermRegistry>(),
      .measure = &measure,
      .refinement = settings_,
      .interrupted = [&] { return context.interrupted(); },
      .report = [&](double done, std::string_view what) { context.progress(done, what); }};
  auto found = check_mounts(refined.outcome.model, sample, context.rig(), settings);
  const bool contradicts_rig = !check.caveats.empty() && !check.is_explained;
  const bool is_doubtful = !agrees_well(refined) || contradicts_rig || may_be_folded(refined, sample);
  const bool is_undetermined = !refined.outcome.caveats.empty();
  if (!found.empty() || (!is_doubtful && !is_undetermined)) return found;
  RigErrorSearch search(sample, context.rig(), settings);
  if (auto counts = search.counts()) return {std::move(*counts)};
  // In the part of a turn to which too large counts squeeze the scene, views agree with anything.
  auto mistake = is_doubtful ? search.any() : search.factor_of_counts();
  if (mistake) found.push_back(std::move(*mistake));
  return found;
}

void RefineStage::judge(const estimate::Sample& sample, const Refinement& refined, Calibration& calibration,
                        Context& context) const {
  const auto& registrar = *context.run().registrar;
  const auto& terms = registrar.get<TermRegistry>();
  const auto measure =
      registrar.get<MeasureRegistry>().make("rqe", MeasureSettings{}, registrar.get<SearchRegistry>());
  const auto rqe = rqe_of({refined.outcome.model, SensorModel(nominal_calibration(context.rig()), terms),
                           SensorModel(*start_, terms)},
                          estimate::longest_recording(sample), {.sigma = sigma_}, *measure);
  calibration.quality = {{"rqe_before", rqe[1]},
                         {"rqe_unrefined", rqe[2]},
                         {"rqe_after", rqe[0]},
                         {"rqe_sigma", sigma_},
                         {"chi2", refined.chi2}};
  context.report({{"surfels", refined.surfels},
                  {"beams", refined.beams},
                  {"chi2", refined.chi2},
                  {"rounds", refined.rounds},
                  {"converged", refined.converged}});
  const double noise = settings_.surfels.noise;
  context.print(fmt::format(
      "{} flat surfaces with {} beams after {} rounds; residuals {:.1f} mm (RMS), {:.2f} times the ranges' noise ({} or less is good)",
      refined.surfels, refined.beams, refined.rounds, misfit_of(refined, noise) * 1e3,
      relative_misfit(refined, noise), kPoorFit));
  report(refined.views, context);
  for (const auto& name : known_from_rig_only(calibration, settings_.prior)) {
    context.print(name + ": determined by the rig's value only; these data do not determine it better");
  }
  context.report({{"misfit", misfit_of(refined, noise)}, {"neighbour_noise", refined.scatter}});
  const auto of_silence = check_silence(sample.beams, context.rig());
  for (const auto& caveat : of_silence) context.mark_untrusted(caveat);
  const auto of_fit = check_fit(refined, calibration, *start_, context.rig(), noise);
  const RigCheck check = check_with_rig(calibration, context.rig(), {});
  const auto of_rig = mistakes(sample, refined, check, *measure, context);
  for (const auto& mistake : of_rig) context.mark_untrusted(mistake);
  // A known mistake explains the other caveats, which nobody needs to examine before it is corrected.
  for (const auto& caveat : of_fit) {
    if (of_rig.empty())
      context.mark_untrusted(caveat);
    else
      context.print("probably for that reason: " + caveat);
  }
  note_direction(calibration, context.rig(), check);
  const bool was_open = std::ranges::count(start_->caveats, kDirectionIsOpen) > 0;
  if (!leaves_direction_open(context.rig(), check))
    report_direction(calibration, *start_, context);
  else if (!was_open)
    context.mark_untrusted(std::string(kDirectionIsOpen));
  const bool is_fine = of_rig.empty() && of_fit.empty() && of_silence.empty() && check.caveats.empty();
  if (is_fine && are_resolved(start_->caveats, check)) {
    context.resolve_caveats(KindName<Calibration>::value,
                            "the refined calibration fits, and agrees with the rig");
  } else if (check.is_explained || !of_rig.empty()) {
    context.resolve_caveats(KindName<Calibration>::value,
                            "the refined values, which are more accurate, show what is wrong in the rig");
  }
}

}  // namespace crisp::calibrate
