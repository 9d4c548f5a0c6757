// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/basin_stage.hpp"

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

#include "grabbers/simulate/scenario_options.hpp"
#include "plugins/study/basin_text.hpp"
#include "plugins/study/rqe.hpp"
#include "plugins/study/run_json.hpp"

namespace crisp::study {

BasinStage::BasinStage() {
  trial().truth = {.tau = 0.02, .alpha = 3 * data::kDegree, .lambda = 5 * data::kDegree, .eta = 0.04};
}

void BasinStage::describe(StageDescription<BasinStage>& d) {
  d.name("study.basin").summary("determines the calibration's basin of convergence");
  d.details(
      "Calibrates simulated recordings by calibrate.rqe and calibrate.refine from starts drawn evenly over the range: tau, alpha and eta of each laser, and lambda of all but the first. Counts how many end in the optimum at the truth (calibrate.refine alone, started at the truth), elsewhere with a caveat, an unobservable parameter or an error, and elsewhere without one. The truth of each recording is drawn up to 2 cm, 3 degrees, 5 degrees (lambda) and 40 ms from the rig's nominal values.");
  simulate::describe_scene(d, &BasinStage::scene_);
  const auto trial = &BasinStage::trial;
  d.option("beams", trial, &TrialSettings::beams,
           "beams used: the paper's two in the plate's plane, or the whole field of view")
      .choices({{"in_plane", BeamChoice::kInPlane}, {"all", BeamChoice::kAll}});
  d.option("starts", &BasinStage::settings_, &BasinSettings::starts, "number of starts").range(1, 1e6);
  d.option("starts_per_recording", &BasinStage::settings_, &BasinSettings::starts_per_recording,
           "number of starts per recording; each recording has its own seed, truth and motion")
      .range(1, 1e6);
  d.option("same", &BasinStage::settings_, &BasinSettings::same,
           "largest difference of parameters, in standard errors, between ends in the same optimum")
      .range(1e-6, 100);
  d.option("lasers", trial, &TrialSettings::lasers, "number of lasers, the first of the rig's").range(1, 64);
  d.option("duration", trial, &TrialSettings::duration, "duration of each recording")
      .unit("s")
      .range(1, 1000);
  simulate::describe_motion(d, &BasinStage::motion);
  d.option("noise", trial, &TrialSettings::noise, "standard deviation of a range").unit("m").range(1e-5, 1);
  const auto range = &BasinSettings::range;
  d.option("min_tau", &BasinStage::settings_, range, &StartRange::min_tau, "smallest tau of a start")
      .unit("m")
      .range(-10, 10);
  d.option("max_tau", &BasinStage::settings_, range, &StartRange::max_tau, "largest tau of a start")
      .unit("m")
      .range(-10, 10);
  d.option("alpha", &BasinStage::settings_, range, &StartRange::alpha, "largest error of alpha at a start")
      .unit("rad")
      .range(0, 3.2);
  d.option("lambda", &BasinStage::settings_, range, &StartRange::lambda, "largest error of lambda at a start")
      .unit("rad")
      .range(0, 3.2);
  d.option("eta", &BasinStage::settings_, range, &StartRange::eta, "largest error of eta at a start")
      .unit("s")
      .range(0, 1);
  describe_part(d, &BasinStage::part_);
  d.option("file", &BasinStage::file_, "output file of all starts, CSV").writes();
}

void BasinStage::check(const RunSettings& run) const {
  check_all([&] { check_part(part_, run); }, [&] { check_lasers(settings_.trial, run.rig); },
            of_option("max_tau",
                      [&] {
                        if (settings_.range.min_tau <= settings_.range.max_tau) return;
                        throw Error("min_tau is above max_tau", "give a `max_tau` above `min_tau`");
                      }),
            [&] { simulate::make_motion(settings_.trial.motion, settings_.trial.duration, 1); });
}

void BasinStage::process(const Inputs&, Outputs&, Context& context) {
  BasinSettings settings = settings_;
  settings.first_seed = context.seed();
  settings.threads = context.threads();
  settings.trial.rig = context.rig();
  settings.trial.scene = scene_.load(context);
  if (part_.is_part()) settings.part = batch::parse_shard(part_.part);
  extent_ = {.first_seed = settings.first_seed, .runs = settings.recordings()};
  const auto progress = [&](std::size_t done) {
    context.progress({.done = static_cast<double>(done),
                      .total = static_cast<double>(share_of(settings.part, extent_.runs)),
                      .unit = "recordings"});
  };
  const auto explore = [&] {
    return explore_basin(settings, rqe_maker(context.run()),
                         {.progress = progress, .interrupted = [&] { return context.interrupted(); }});
  };
  recordings_ = run_or_read<BasinRecording>(context, part_, extent_, explore, basin_of);
}

void BasinStage::finish(Outputs&, Context& context) {
  if (write_if_part(context, part_, extent_, recordings_, basin_json)) return;
  const BasinTally tally = tally_of(recordings_);
  context.print(basin_text(recordings_));
  context.report({{"starts", tally.starts},
                  {"same", tally.same},
                  {"same_doubted", tally.same_with_caveats},
                  {"caveats", tally.with_caveats},
                  {"silent", tally.silent},
                  {"recordings_failed", tally.failed}});
  if (file_.empty()) return;
  write_file(file_, basin_csv(recordings_));
  context.wrote(file_);
}

}  // namespace crisp::study
