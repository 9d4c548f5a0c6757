// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/model_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <crisp/registrar.hpp>

#include "pipeline/data/goodness_of_fit_tests.hpp"
#include "pipeline/data/recordings.hpp"
#include "pipeline/estimate/recording_lags.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "plugins/diagnose/model/clock_lines.hpp"
#include "plugins/diagnose/model/estimator_artifacts.hpp"
#include "plugins/diagnose/report/findings_report.hpp"
#include "plugins/diagnose/report/residual_plots.hpp"

namespace crisp::diagnose {
namespace {

void draw(const std::filesystem::path& folder, const Diagnosis& diagnosis, Context& context) {
  std::vector<std::string> lasers;
  for (const auto& laser : context.rig().lasers) lasers.push_back(laser.name);
  const auto draw_one = [&](std::size_t laser, const std::string& name) {
    const auto plots = residual_plots(laser, lasers, diagnosis.left_before, diagnosis.left_after);
    if (!plots.empty()) plot::write_plots(folder / (name + "_residuals.svg"), plots, context);
  };
  for (std::size_t laser = 0; laser < lasers.size(); ++laser) draw_one(laser, lasers[laser]);
  draw_one(kAllLasers, "scanner");
}

/// Candidates already estimated from timestamps: the clock stages use each mirror's measured rate.
std::set<std::string> determined_by_stamps(const Findings& findings) {
  std::set<std::string> reported;
  for (const DeviceFacts& facts : findings.devices) {
    if (facts.period > 0) reported.insert(facts.device + ".mirror.period");
  }
  return reported;
}

bool extends(const Diagnosis& diagnosis) {
  return std::ranges::any_of(diagnosis.hypotheses, &Hypothesis::accepted);
}

/// Whether the extension resolves the caveats of the incoming calibration: the residuals of the extended
/// model agree with noise, and it has no caveats of its own.
bool resolves_caveats(const Diagnosis& diagnosis) {
  constexpr double kLikely = 0.01;
  return extends(diagnosis) && diagnosis.settled && diagnosis.after.outcome.caveats.empty() &&
         diagnosis.left_after.p_value > kLikely;
}

}  // namespace

void DiagnoseModelStage::describe(StageDescription<DiagnoseModelStage>& d) {
  d.name("diagnose.model").summary("identifies effects that the sensor model lacks, and extends it by them");
  d.details(
      "Tests every effect of the catalogue in the distances of all beams to the flat surfaces they meet (score tests with stepwise selection by BIC). It adds the significant effects to the calibration and reports their gain on held-out turns of the plate (cross-validation). With several recordings, separated by pauses of 5 s, it holds out every other recording. It then does not test effects of time, or of angles that count from another zero. The incoming calibration must be accurate to a few centimetres: run calibrate.refine first.");
  d.takes<Measurements>()
      .takes<Findings>(Need::optional)
      .takes<ClockMap>(Need::optional)
      .holds<PlateTrajectory>()
      .holds<Calibration>()
      .gives<Findings>()
      .gives<Calibration>();
  d.option("noise", &DiagnoseModelStage::noise_, "standard deviation of ranges").unit("m").range(1e-6, 1);
  d.option(
       "beams", &DiagnoseModelStage::settings_, &DiagnosisSettings::beams,
       "number of beams in the first tests and in the residual profiles; more beams detect smaller effects and take longer")
      .range(1000, 1e8);
  d.option("refine_beams", &DiagnoseModelStage::settings_, &DiagnosisSettings::refine_beams,
           "number of beams in the final search for smaller causes; 0 skips that search")
      .range(0, 1e8);
  d.option("rounds", &DiagnoseModelStage::settings_, &DiagnosisSettings::rounds,
           "maximum number of model extensions; raise it if the extended model is reported as unfinished")
      .range(1, 100);
  d.option(
       "folder", &DiagnoseModelStage::folder_,
       "folder for plots of each laser's residuals, with and without the identified effects; auto: no plots")
      .writes_into({"*_residuals.svg"});
}

void DiagnoseModelStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) all_.append(*before);
  if (const auto* clock = in.find<ClockMap>()) clocks_.insert_or_assign(clock->device, *clock);
  if (!in.find<Measurements>()) return;
  start_ = in.share<Calibration>();
  collected_.add(in.share<Measurements>(),
                 oriented_(in.share<PlateTrajectory>(), start_.get(), context.rig()));
}

void DiagnoseModelStage::finish(Outputs& out, Context& context) {
  estimate::Sample sample = collected_.sample();
  context.count("beams left out of the diagnosis of a long recording", collected_.left_out());
  settings_.refinement.surfels.noise = noise_;
  settings_.refinement.angle_step = std::abs(context.rig().plate.angle_per_count());
  settings_.refinement.prior.nominal = estimate::nominal_values(context.rig());
  const auto& terms = context.run().registrar->get<TermRegistry>();
  Calibration base = *start_;
  if (data::RecordingNumbers(*sample.plate).count() > 1) {
    context.progress(0, "estimating each recording's lags");
    const estimate::RecordingLags lags =
        estimate::lags_of_recordings(SensorModel(base, terms), sample, settings_.refinement);
    sample = estimate::with_common_lags(std::move(sample), lags);
  } else {
    const double middle = 0.5 * (sample.plate->begin() + sample.plate->end());
    add_clock_lines(base, settings_.refinement.prior, skew_errors(context.rig(), clocks_), middle, terms);
  }
  settings_.excluded = determined_by_stamps(all_);
  settings_.interrupted = [&context] { return context.interrupted(); };
  const Diagnosis diagnosis =
      diagnose(SensorModel(base, terms), sample, terms, settings_,
               [&context](double fraction, const std::string& what) { context.progress(fraction, what); });
  if (!diagnosis.settled) {
    context.mark_untrusted(
        fmt::format("after {} rounds the extended model still lacked a significant effect; raise `rounds`",
                    settings_.rounds));
  }
  for (const auto& caveat : diagnosis.after.outcome.caveats) context.mark_untrusted(caveat);
  if (resolves_caveats(diagnosis)) {
    context.resolve_caveats(KindName<Calibration>::value,
                            fmt::format("the residuals of the extended model agree with simulated noise ({})",
                                        data::chance_in_words(diagnosis.left_after.p_value)));
  }
  Calibration calibration =
      estimate::calibration_of(without_clock_lines(diagnosis.after.outcome, terms), context.rig());
  calibration.provenance = start_->provenance;
  calibration.provenance["diagnosis"] = "diagnose.model";
  calibration.quality = start_->quality;
  calibration.quality["chi2"] = diagnosis.after.chi2;
  // rqe_after describes the incoming calibration, not the extended one.
  if (auto known = calibration.quality.extract("rqe_after")) {
    known.key() = "rqe_undiagnosed";
    calibration.quality.insert(std::move(known));
  }
  Findings findings = findings_of(diagnosis, calibration, terms, settings_.selection, noise_);
  for (const auto& artifact : {aliasing(sample), density_bias(*start_, diagnosis.before.outcome),
                               clock_lines(diagnosis.after.outcome, settings_.refinement.prior)}) {
    if (artifact) findings.artifacts.push_back(*artifact);
  }
  context.print(in_words(diagnosis, findings));
  // Tables that earlier stages printed are outdated.
  if (extends(diagnosis)) context.print(estimate::table_of(calibration, context.rig()));
  if (folder_) draw(*folder_, diagnosis, context);
  context.report({{"findings", findings.findings.size()},
                  {"unnamed", findings.unnamed.size()},
                  {"departures", findings.departures.size()},
                  {"before_p", findings.before_p},
                  {"after_p", findings.after_p}});
  all_.append(findings);
  out.give(std::move(all_));
  out.give(std::move(calibration));
}

}  // namespace crisp::diagnose
