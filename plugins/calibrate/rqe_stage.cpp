// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rqe_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/data/all_errors.hpp"
#include "pipeline/stage/option_check.hpp"
#include "pipeline/stage/registry.hpp"
#include "plugins/calibrate/cloud_objective.hpp"
#include "plugins/calibrate/report.hpp"
#include "plugins/calibrate/rig_check.hpp"
#include "plugins/calibrate/rig_search.hpp"
#include "plugins/calibrate/single_beams.hpp"

namespace crisp {

void RqeStage::describe(StageDescription<RqeStage>& d) {
  d.name("calibrate.rqe")
      .summary("turns lambda, tau, alpha and eta until the cloud is as crisp as it can be");
  d.details(
      "From the data alone, in two steps. First the two beams of each laser that lie in the plate's plane, "
      "in the order of Sheehan, Harrison and Newman: each eta, each tau and alpha, each lambda around the "
      "whole circle. Then the whole field of view, with the kernel narrowing. It starts from the rig's "
      "nominal "
      "values, or from those of a calibrate.load above. The standard errors show the scatter that noise "
      "causes; a bias of some millimetres, which an entropy's optimum has, is left to calibrate.refine.\n\n"
      "A plate that stands still is refused. One that is only seen in a few directions, since its rate and "
      "the mirrors' are commensurate (2 and 50 Hz, exactly), is calibrated with a warning not to trust it. "
      "Of "
      "several recordings (what pauses of 5 s divide) the longest is looked at.");
  d.takes<Measurements>().holds<PlateTrajectory>().holds<Calibration>(Need::optional).gives<Calibration>();
  d.option("sigma", &RqeStage::sigma_, "kernel width over the whole field of view: at first, and at last")
      .unit("m")
      .range(1e-3, 10)
      .count(2, 2);
  d.option("in_plane_sigma", &RqeStage::in_plane_sigma_, "and for the beams in the plate's plane")
      .unit("m")
      .range(1e-3, 10)
      .count(2, 2);
  d.option("in_plane_width", &RqeStage::settings_, &RqeCalibrationSettings::in_plane,
           &InPlaneSettings::half_width, "largest angle of a beam to that plane")
      .unit("rad")
      .range(0, 0.1);
  d.option("full_field", &RqeStage::settings_, &RqeCalibrationSettings::full_field,
           "whether the whole field of view follows; the paper has the two beams alone");
  d.option("points", &RqeStage::settings_, &RqeCalibrationSettings::points,
           "about so many points are looked at, spread evenly over the surfaces")
      .range(1000, 1e7);
  d.option("lambda_range", &RqeStage::range_, &SearchRange::lambda,
           "how far lambda is turned at a time; where it starts does not matter")
      .unit("rad")
      .range(1e-6, 3.2);
  d.option("tau_range", &RqeStage::range_, &SearchRange::tau, "how far tau may be from its start")
      .unit("m")
      .range(1e-6, 10);
  d.option("alpha_range", &RqeStage::range_, &SearchRange::alpha, "how far alpha may be from its start")
      .unit("rad")
      .range(1e-6, 1.5);
  d.option("eta_range", &RqeStage::range_, &SearchRange::eta, "how far eta may be from its start")
      .unit("s")
      .range(1e-6, 1);
  d.option("fixed", &RqeStage::settings_, &RqeCalibrationSettings::fixed,
           "parameters that are left as they are: laser1.eta, or eta for that of all lasers");
  d.option("noise", &RqeStage::settings_, &RqeCalibrationSettings::noise,
           "standard deviation of a range, for the standard errors")
      .unit("m")
      .range(1e-6, 1);
  d.option("measure", &RqeStage::measure_, "what is lowest when a cloud is crispest: rqe, or a plugin's");
  d.option("search", &RqeStage::measure_settings_, &MeasureSettings::search,
           "how neighbours are found: grid, flann, exact, or a plugin's");
  d.option("cutoff", &RqeStage::measure_settings_, &MeasureSettings::cutoff,
           "distance in kernel widths beyond which pairs are left out")
      .range(1, 12);
}

std::unique_ptr<Measure> RqeStage::make_measure(const RunSettings& run) const {
  return run.registrar->get<MeasureRegistry>().make(measure_, measure_settings_,
                                                    run.registrar->get<SearchRegistry>());
}

void RqeStage::check(const RunSettings& run) const {
  const auto narrows = [](const auto& sigma, const char* name) {
    return of_option(name, [&sigma, name] {
      if (sigma[0] >= sigma[1]) return;
      throw Error(std::string(name) + ": the kernel has to become narrower, not wider",
                  "write the larger sigma first");
    });
  };
  check_all(narrows(sigma_, "sigma"), narrows(in_plane_sigma_, "in_plane_sigma"),
            of_option("fixed", [&] { check_fixed(settings_.fixed, nominal_calibration(run.rig)); }),
            of_option("measure", [&] { make_measure(run); }));
}

void RqeStage::process(const Inputs& in, Outputs&, Context& context) {
  if (!start_) start_ = in.share<Calibration>();
  collected_.add(in.share<Measurements>(),
                 oriented_(in.share<PlateTrajectory>(), start_.get(), context.rig()));
}

Calibration RqeStage::compared_with_rig(Calibration calibration, Context& context) const {
  const RigCheck check = check_with_rig(calibration, context.rig(), range_);
  const bool asks_direction = context.rig().plate.direction == CountDirection::automatic && !start_;
  if (!start_) {
    if (auto turned = in_direction_of_rig(calibration, context.rig(), check)) {
      context.warn(kCountsClockwise);
      return std::move(*turned);
    }
  }
  if (asks_direction && !check.knows_direction) {
    calibration.doubts.emplace_back(
        "nothing shows which way the encoder counts, as the mirror image agrees with the rig's nominal "
        "values as well: the cloud may be the mirror image of the scene. Set plate.direction in the rig");
    context.distrust(calibration.doubts.back());
  } else if (!check.knows_direction && !start_) {
    context.say(
        "plate.direction is known from the rig only: the mirror image agrees with the nominal values as "
        "well");
  }
  for (const auto& caveat : check.caveats) context.distrust(caveat);
  return calibration;
}

void RqeStage::finish(Outputs& out, Context& context) {
  const Sample sample = longest_recording(collected_.sample());
  context.count("beams left out of the calibration of a long recording", collected_.left_out());
  RqeCalibrationSettings settings = settings_;
  settings.sigma_from = sigma_[0];
  settings.sigma_to = sigma_[1];
  settings.in_plane.sigma_from = in_plane_sigma_[0];
  settings.in_plane.sigma_to = in_plane_sigma_[1];
  settings.in_plane.range = range_;
  settings.in_plane.minimiser.interrupted = [&] { return context.interrupted(); };
  settings.seed = context.seed();
  const auto measure = make_measure(context.run());
  const auto& terms = context.run().registrar->get<TermRegistry>();
  const Calibration start = start_ ? *start_ : nominal_calibration(context.rig());
  refuse_single_beams(sample.beams, start, settings_.fixed);
  const Outcome outcome =
      search_around_rig(SensorModel(start, terms), sample, *measure, settings, context.rig(),
                        [&](double done, std::string_view what) { context.progress(done, what); });
  if (context.interrupted()) return;

  for (const auto& doubt : outcome.doubts) context.distrust(doubt);
  for (const auto& minimum : outcome.other_minima) context.distrust(minimum);
  Calibration calibration = calibration_of(outcome, context.rig());
  calibration.doubts = outcome.doubts;  // of the data: no refinement answers them
  const double sigma = settings.full_field ? settings.sigma_to : settings.in_plane.sigma_to;
  const auto crispness = crispness_of({outcome.model, SensorModel(start, terms)}, sample,
                                      {.sigma = sigma, .points = settings.points}, *measure);
  calibration.quality = {{"rqe_before", crispness[1]}, {"rqe_after", crispness[0]}, {"rqe_sigma", sigma}};
  calibration.provenance["calibration"] = "calibrate.rqe";
  calibration = compared_with_rig(std::move(calibration), context);
  if (calibration.quality.at("rqe_after") > calibration.quality.at("rqe_before")) {
    context.distrust("the calibration made the cloud less crisp than it was");
  }
  if (outcome.free.empty()) context.distrust("RQE determines none of the parameters");
  if (!outcome.not_estimated.empty()) {
    std::vector<std::string> names;
    for (const std::size_t parameter : outcome.not_estimated)
      names.push_back(outcome.model.names()[parameter]);
    context.say(
        fmt::format("{} stay as they were: the laser sees one side of the spin axis only, and a smaller room "
                    "would be as crisp (calibrate.refine finds them)",
                    fmt::join(names, ", ")));
  }
  tell(calibration, {}, context);
  context.say(
      "standard errors count how beams scatter; by how much the crispest cloud is not the true one comes on "
      "top, some millimetres (calibrate.refine)");
  out.give(std::move(calibration));
}

}  // namespace crisp
