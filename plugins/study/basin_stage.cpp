// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/basin_stage.hpp"

#include "grabbers/simulate/world_options.hpp"
#include "pipeline/data/all_errors.hpp"
#include "pipeline/data/error.hpp"
#include "pipeline/files/atomic_file.hpp"
#include "pipeline/stage/option_check.hpp"
#include "plugins/study/basin_text.hpp"
#include "plugins/study/rqe.hpp"
#include "plugins/study/run_json.hpp"

namespace crisp {

BasinStage::BasinStage() {
  trial().truth = {.tau = 0.02, .alpha = 3 * kDegree, .lambda = 5 * kDegree, .eta = 0.04};
}

void BasinStage::describe(StageDescription<BasinStage>& d) {
  d.name("study.basin").summary("calibrates from starts all over the range, and sees where each ends");
  d.details(
      "Simulated recordings are calibrated by calibrate.rqe and calibrate.refine from starts drawn evenly "
      "over "
      "the range: tau, alpha and eta of each laser, and lambda of all but the first. Counted is how many end "
      "in "
      "the optimum at the truth (calibrate.refine alone, started at the truth), elsewhere but saying that "
      "they "
      "are not sure (a doubt, a parameter that is named unobservable, an error), or elsewhere and sure of "
      "it. "
      "The truth of each recording is drawn up to 2 cm, 3 degrees, 5 degrees (lambda) and 40 ms from the "
      "rig's "
      "nominal values.");
  describe_scene(d, &BasinStage::scene_);
  const auto trial = &BasinStage::trial;
  d.option("beams", trial, &TrialSettings::beams,
           "the paper's two in the plate's plane, or those of the whole field of view")
      .choices({{"in_plane", BeamChoice::kInPlane}, {"all", BeamChoice::kAll}});
  d.option("starts", &BasinStage::settings_, &BasinSettings::starts, "how many").range(1, 1e6);
  d.option("starts_a_recording", &BasinStage::settings_, &BasinSettings::starts_a_recording,
           "how many of them share a recording; each recording has its own seed, truth and motion")
      .range(1, 1e6);
  d.option("same", &BasinStage::settings_, &BasinSettings::same,
           "standard errors by which each parameter of two ends may differ that count as the same")
      .range(1e-6, 100);
  d.option("lasers", trial, &TrialSettings::lasers, "how many, of the rig's").range(1, 64);
  d.option("duration", trial, &TrialSettings::duration, "of each recording").unit("s").range(1, 1000);
  describe_motion(d, &BasinStage::motion);
  d.option("noise", trial, &TrialSettings::noise, "standard deviation of a range").unit("m").range(1e-5, 1);
  const auto range = &BasinSettings::range;
  d.option("tau_least", &BasinStage::settings_, range, &StartRange::tau_least, "least tau of a start")
      .unit("m")
      .range(-10, 10);
  d.option("tau_most", &BasinStage::settings_, range, &StartRange::tau_most, "largest tau of a start")
      .unit("m")
      .range(-10, 10);
  d.option("alpha", &BasinStage::settings_, range, &StartRange::alpha, "how far off alpha is at most")
      .unit("rad")
      .range(0, 3.2);
  d.option("lambda", &BasinStage::settings_, range, &StartRange::lambda, "and lambda")
      .unit("rad")
      .range(0, 3.2);
  d.option("eta", &BasinStage::settings_, range, &StartRange::eta, "and eta").unit("s").range(0, 1);
  describe_part(d, &BasinStage::part_);
  d.option("file", &BasinStage::file_, "where every start goes, as CSV").writes();
}

void BasinStage::check(const RunSettings& run) const {
  check_all([&] { check_part(part_, run); }, [&] { check_lasers(settings_.trial, run.rig); },
            of_option("tau_most",
                      [&] {
                        if (settings_.range.tau_least <= settings_.range.tau_most) return;
                        throw Error("the least tau of a start is above the largest",
                                    "give a `tau_most` above `tau_least`");
                      }),
            [&] { make_motion(settings_.trial.motion, settings_.trial.duration, 1); });
}

void BasinStage::process(const Inputs&, Outputs&, Context& context) {
  BasinSettings settings = settings_;
  settings.first_seed = context.seed();
  settings.threads = context.threads();
  settings.trial.rig = context.rig();
  settings.trial.scene = scene_.load(context);
  if (part_.is_part()) settings.part = parse_shard(part_.part);
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
  context.say(basin_text(recordings_));
  context.report({{"starts", tally.starts},
                  {"same", tally.same},
                  {"same_doubted", tally.same_doubted},
                  {"doubted", tally.doubted},
                  {"silent", tally.silent},
                  {"recordings_failed", tally.failed}});
  if (file_.empty()) return;
  write_file(file_, basin_csv(recordings_));
  context.wrote(file_);
}

}  // namespace crisp
