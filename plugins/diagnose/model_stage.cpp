// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "pipeline/data/likeness.hpp"
#include "pipeline/data/recordings.hpp"
#include "pipeline/estimate/recording_lags.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "pipeline/stage/registry.hpp"
#include "plugins/diagnose/artefacts.hpp"
#include "plugins/diagnose/report.hpp"
#include "plugins/diagnose/residual_plots.hpp"

namespace crisp {
namespace {

void draw(const std::filesystem::path& folder, const Diagnosis& diagnosis, Context& context) {
  std::vector<std::string> lasers;
  for (const auto& laser : context.rig().lasers) lasers.push_back(laser.name);
  const auto draw_one = [&](std::size_t laser, const std::string& name) {
    const auto plots = residual_plots(laser, lasers, diagnosis.left_before, diagnosis.left_after);
    if (!plots.empty()) write_plots(folder / (name + "_residuals.svg"), plots, context);
  };
  for (std::size_t laser = 0; laser < lasers.size(); ++laser) draw_one(laser, lasers[laser]);
  draw_one(kAllLasers, "scanner");
}

/// What stamps have told already: clock stages place beams by the rate of each mirror as it was measured.
std::set<std::string> told_by_stamps(const Findings& findings) {
  std::set<std::string> told;
  for (const DeviceFacts& facts : findings.devices) {
    if (facts.period > 0) told.insert(facts.device + ".mirror.period");
  }
  return told;
}

bool extends(const Diagnosis& diagnosis) {
  return std::ranges::any_of(diagnosis.departures, &Departure::accepted);
}

/// Whether what was doubtful of a model that lacked something is answered: the extended one leaves nothing
/// but noise, and has no doubts of its own.
bool answers_doubts(const Diagnosis& diagnosis) {
  constexpr double kLikely = 0.01;
  return extends(diagnosis) && diagnosis.settled && diagnosis.after.outcome.doubts.empty() &&
         diagnosis.left_after.p_value > kLikely;
}

}  // namespace

void DiagnoseModelStage::describe(StageDescription<DiagnoseModelStage>& d) {
  d.name("diagnose.model").summary("names what the model of the sensor lacks, and extends it by that");
  d.details(
      "Looks for every effect of the catalogue in the distances of all beams to the flat surfaces that they "
      "meet, takes into the model what is needed, and says what that brings on turns of the plate that it "
      "was not fitted to. Of several recordings (what pauses of 5 s divide) every other one is held out "
      "instead, "
      "and what goes by time, or by angles that count from another zero, is not looked for. It needs a "
      "calibration that is right to some centimetres: calibrate.refine.");
  d.takes<Measurements>()
      .takes<Findings>(Need::optional)
      .holds<PlateTrajectory>()
      .holds<Calibration>()
      .gives<Findings>()
      .gives<Calibration>();
  d.option("noise", &DiagnoseModelStage::noise_, "standard deviation of a range").unit("m").range(1e-6, 1);
  d.option("beams", &DiagnoseModelStage::settings_, &DiagnosisSettings::beams,
           "that candidates are looked at with at first, and residuals are compared of")
      .range(1000, 1e8);
  d.option("closer", &DiagnoseModelStage::settings_, &DiagnosisSettings::closer,
           "beams that causes are looked at with in the end, which shows fainter ones; 0: not at all")
      .range(0, 1e8);
  d.option("rounds", &DiagnoseModelStage::settings_, &DiagnosisSettings::rounds,
           "most times that the model is extended and looked at again")
      .range(1, 100);
  d.option("folder", &DiagnoseModelStage::folder_,
           "where plots of each laser's residuals go, with and without what was found; auto: nowhere")
      .writes_into({"*_residuals.svg"});
}

void DiagnoseModelStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) all_.append(*before);
  if (!in.find<Measurements>()) return;
  start_ = in.share<Calibration>();
  collected_.add(in.share<Measurements>(),
                 oriented_(in.share<PlateTrajectory>(), start_.get(), context.rig()));
}

void DiagnoseModelStage::finish(Outputs& out, Context& context) {
  Sample sample = collected_.sample();
  context.count("beams left out of the diagnosis of a long recording", collected_.left_out());
  settings_.refinement.surfels.noise = noise_;
  settings_.refinement.prior.nominal = nominal_values(context.rig());
  const auto& terms = context.run().registrar->get<TermRegistry>();
  const SensorModel start(*start_, terms);
  if (RecordingNumbers(*sample.plate).count() > 1) {
    context.progress(0, "finding each recording's lags");
    const RecordingLags lags = lags_of_recordings(start, sample, settings_.refinement);
    sample = with_common_lags(std::move(sample), lags);
  }
  settings_.excluded = told_by_stamps(all_);
  settings_.interrupted = [&context] { return context.interrupted(); };
  const Diagnosis diagnosis =
      diagnose(start, sample, terms, settings_,
               [&context](double fraction, const std::string& what) { context.progress(fraction, what); });
  if (!diagnosis.settled) {
    context.distrust("the extended model still asked for something else after the last round");
  }
  for (const auto& doubt : diagnosis.after.outcome.doubts) context.distrust(doubt);
  if (answers_doubts(diagnosis)) {
    context.lift_doubts(
        KindName<Calibration>::value,
        fmt::format("with what it lacked in it, the model leaves what the simulation does ({})",
                    chance_in_words(diagnosis.left_after.p_value)));
  }
  Calibration calibration = calibration_of(diagnosis.after.outcome, context.rig());
  calibration.provenance = start_->provenance;
  calibration.provenance["diagnosis"] = "diagnose.model";
  calibration.quality = start_->quality;
  calibration.quality["chi2"] = diagnosis.after.chi2;
  // That of the calibration that came is none of this one's.
  if (auto known = calibration.quality.extract("rqe_after")) {
    known.key() = "rqe_undiagnosed";
    calibration.quality.insert(std::move(known));
  }
  Findings findings = findings_of(diagnosis, calibration, terms, settings_.selection, noise_);
  for (const auto& artefact : {aliasing(sample), density_bias(*start_, diagnosis.before.outcome)}) {
    if (artefact) findings.artefacts.push_back(*artefact);
  }
  context.say(in_words(diagnosis, findings));
  // What stages above printed is no longer what the calibration holds.
  if (extends(diagnosis)) context.say(table_of(calibration, context.rig()));
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

}  // namespace crisp
