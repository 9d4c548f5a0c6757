// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/monte_carlo_stage.hpp"

#include <fmt/format.h>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>
#include <crisp/registrar.hpp>

#include "grabbers/simulate/device_effects.hpp"
#include "grabbers/simulate/real_devices.hpp"
#include "grabbers/simulate/scenario_options.hpp"
#include "plugins/study/rqe.hpp"
#include "plugins/study/run_json.hpp"
#include "plugins/study/table.hpp"

namespace crisp::study {
namespace {

/// Null without successful runs.
nlohmann::json json_of_runs(const Scatter& scatter) {
  if (scatter.estimates == 0) return nullptr;
  return {{"mean", scatter.mean}, {"std_dev", scatter.std_dev}};
}

nlohmann::json json_of(const Table& table) {
  nlohmann::json json = {{"runs", table.runs},
                         {"rqe_astray", table.rqe_astray},
                         {"refined_astray", table.refined_astray},
                         {"refined_failed", table.refined_failed}};
  for (const ErrorRow& row : table.rows) {
    nlohmann::json entry = {{"unit", row.unit},
                            {"bound", row.bound},
                            {"bound_with_steps", row.bound_with_steps},
                            {"refined", json_of_runs(row.refined)}};
    const bool reported = row.refined.estimates > 0;
    entry["std_error"] = reported ? nlohmann::json(row.refined.estimated) : nullptr;
    entry["within_68"] = reported ? nlohmann::json(row.refined.one) : nullptr;
    entry["within_95"] = reported ? nlohmann::json(row.refined.two) : nullptr;
    if (row.rqe) entry["rqe"] = json_of_runs(*row.rqe);
    if (row.paper) entry["paper"] = {{"mean", row.paper->mean}, {"std_dev", row.paper->std_dev}};
    json[row.parameter] = std::move(entry);
  }
  return json;
}

}  // namespace

void MonteCarloStage::describe(StageDescription<MonteCarloStage>& d) {
  d.name("study.monte_carlo")
      .summary("Monte Carlo study of calibration errors: reproduces Table 1 of the paper");
  d.details(
      "By default section 5.2 of Sheehan, Harrison and Newman: the two beams of each laser in the plate's plane, in a room of upright walls; tau is 0.20 m, alpha is 0, lambda starts up to half a turn off. Other scenes and the whole field of view are options. The table compares two estimators, the optimum of RQE as in the paper and the least squares against flat surfaces that follow by default, with the paper's figures and with the Cramer-Rao bound for the same beams and an unknown scene. Each run has its own seed, from --seed on, which alone determines its result.\n\n"
      "`estimators: refined` skips RQE, which takes half of the time or more, and starts the refinement where RQE would have ended: up to 5 mm, 0.7 degrees (alpha, lambda) and 0.3 ms off the truth. Such runs do not test whether RQE converges.");
  simulate::describe_scene(d, &MonteCarloStage::scene_);
  d.option("beams", &MonteCarloStage::trial, &TrialSettings::beams,
           "beams used: the paper's two in the plate's plane, or the whole field of view")
      .choices({{"in_plane", BeamChoice::kInPlane}, {"all", BeamChoice::kAll}});
  d.option("estimators", &MonteCarloStage::trial, &TrialSettings::estimators,
           "estimators to run: RQE and the refinement after it, or the refinement alone")
      .choices({{"both", Estimators::kBoth}, {"refined", Estimators::kRefined}});
  d.option("runs", &MonteCarloStage::settings_, &MonteCarloSettings::runs, "number of simulated recordings")
      .range(1, 1e6);
  d.option("lasers", &MonteCarloStage::trial, &TrialSettings::lasers,
           "number of lasers, the first of the rig's")
      .range(1, 64);
  d.option("duration", &MonteCarloStage::trial, &TrialSettings::duration, "duration of each recording")
      .unit("s")
      .range(1, 1000);
  simulate::describe_motion(d, &MonteCarloStage::motion);
  d.option("motion_seed", &MonteCarloStage::trial, &TrialSettings::motion_seed,
           "seed of one plate motion for all runs; auto: each run draws its own");
  d.option("noise", &MonteCarloStage::trial, &TrialSettings::noise, "standard deviation of a range")
      .unit("m")
      .range(1e-5, 1);
  simulate::describe_realism(d, &MonteCarloStage::realism_);
  d.option(
      "effects", &MonteCarloStage::effects_,
      "error effects of the simulated lasers, unknown to the estimators: `{noise.mixed_pixels: {divergence: 15mrad, aperture: 8mm}}`, named as in `crisp effects`");
  d.option(
       "outliers", &MonteCarloStage::trial, &TrialSettings::outliers,
       "fraction of ranges that are replaced by outliers: four fifths of them nearer, the others up to 5 m farther")
      .unit("1")
      .range(0, 1);
  d.option("eta", &MonteCarloStage::trial, &TrialSettings::truth, &simulate::NominalErrors::eta,
           "largest true lag, drawn around 0, where RQE starts")
      .unit("s")
      .range(0, 0.09);
  d.option("tau_off", &MonteCarloStage::start, &simulate::NominalErrors::tau,
           "largest error of tau at RQE's start")
      .unit("m")
      .range(0, 0.1);
  d.option("alpha_off", &MonteCarloStage::start, &simulate::NominalErrors::alpha,
           "largest error of alpha at RQE's start")
      .unit("rad")
      .range(0, 0.3);
  d.option("lambda_off", &MonteCarloStage::start, &simulate::NominalErrors::lambda,
           "largest error of lambda at RQE's start")
      .unit("rad")
      .range(0, 3.2);
  d.option("sigma", &MonteCarloStage::sigma_,
           "kernel width of RQE for the beams in the plate's plane: first and last")
      .unit("m")
      .range(1e-3, 10)
      .count(2, 2);
  describe_part(d, &MonteCarloStage::part_);
  d.option("runs_file", &MonteCarloStage::runs_file_, "output file of all runs, CSV").writes();
  d.option("table_file", &MonteCarloStage::table_file_, "output file of the table, text").writes();
}

void MonteCarloStage::check(const RunSettings& run) const {
  const simulate::MotionSettings& motion = settings_.trial.motion;
  check_all([&] { check_part(part_, run); }, [&] { check_lasers(settings_.trial, run.rig); },
            of_option("sigma",
                      [&] {
                        if (sigma_[0] >= sigma_[1]) return;
                        throw Error("the kernel width must decrease", "write the larger sigma first");
                      }),
            [&] {
              const bool steady =
                  motion.kind == simulate::MotionKind::constant ||
                  (motion.kind == simulate::MotionKind::varying && motion.min_rate == motion.max_rate);
              if (!steady) return;
              throw Error("a plate at constant speed does not distinguish eta from lambda",
                          "let max_rate be larger than min_rate, or choose another motion");
            },
            [&] { simulate::make_motion(motion, settings_.trial.duration, 1); }, [&] { check_effects(run); });
}

void MonteCarloStage::check_effects(const RunSettings& run) const {
  TrialSettings trial = settings_.trial;
  trial.rig = run.rig;
  simulate::effects_of_real_devices(realism_.devices, run.rig,
                                    simulate::laser_catalogue(simulate::known_terms(run)));
  use_effects(trial, run);
}

void MonteCarloStage::use_realism(TrialSettings& trial, Context& context) const {
  if (realism_.empty()) return;
  const auto catalogue = simulate::laser_catalogue(simulate::known_terms(context.run()));
  simulate::RecordingSettings recording{.scanner = {.rig = trial.rig}};
  simulate::apply_device_effects(realism_.load(catalogue, context), recording);
  trial.laser_effects = recording.scanner.laser_effects;
  trial.counted_noise = noise_in(trial, context.seed());
  context.print(fmt::format("ranges have {:.2f} mm (RMS) of noise with the measured devices",
                            1e3 * *trial.counted_noise));
  context.report({{"noise", *trial.counted_noise}});
}

void MonteCarloStage::use_effects(TrialSettings& trial, const RunSettings& run) const {
  if (effects_.empty()) return;
  simulate::RecordingSettings recording{.scanner = {.rig = trial.rig, .laser_effects = trial.laser_effects}};
  simulate::apply_device_effects(
      simulate::read_effects(effects_, trial.rig, simulate::laser_catalogue(simulate::known_terms(run))),
      recording);
  trial.laser_effects = recording.scanner.laser_effects;
}

void MonteCarloStage::process(const Inputs&, Outputs&, Context& context) {
  MonteCarloSettings settings = settings_;
  settings.first_seed = context.seed();
  settings.threads = context.threads();
  settings.trial.rig = context.rig();
  settings.trial.scene = scene_.load(context);
  use_realism(settings.trial, context);
  use_effects(settings.trial, context.run());
  settings.trial.rqe.in_plane.sigma_from = sigma_[0];
  settings.trial.rqe.in_plane.sigma_to = sigma_[1];
  if (part_.is_part()) settings.part = batch::parse_shard(part_.part);
  extent_ = {.first_seed = settings.first_seed, .runs = settings.runs};
  const auto progress = [&](std::size_t done) {
    context.progress({.done = static_cast<double>(done),
                      .total = static_cast<double>(share_of(settings.part, settings.runs)),
                      .unit = "runs"});
  };
  const auto run = [&] {
    return run_trials(settings, rqe_maker(context.run()),
                      {.progress = progress, .interrupted = [&] { return context.interrupted(); }});
  };
  trials_ = run_or_read<MonteCarloTrial>(context, part_, extent_, run, trial_of);
}

void MonteCarloStage::finish(Outputs&, Context& context) {
  if (write_if_part(context, part_, extent_, trials_, trial_json)) return;
  const bool papers = scene_.name == "paper" && scene_.file.empty() && trial().beams == BeamChoice::kInPlane;
  const Table table = table_of(trials_, papers);
  const std::string text = table_text(table);
  context.print(text);
  context.report(json_of(table));
  if (table.runs > 0 && !reports_refinement(table)) {
    context.mark_untrusted(fmt::format(
        "none of {} runs was refined to near the truth: the errors are undetermined", table.runs));
  }
  context.count("runs that could not be refined", table.refined_failed);
  context.count("runs that ended in another local minimum", table.refined_astray);
  if (!runs_file_.empty()) {
    write_file(runs_file_, runs_csv(trials_));
    context.wrote(runs_file_);
  }
  if (!table_file_.empty()) {
    write_file(table_file_, text + "\n");
    context.wrote(table_file_);
  }
}

}  // namespace crisp::study
