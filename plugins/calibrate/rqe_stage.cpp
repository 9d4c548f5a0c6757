// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rqe_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <string_view>
#include <vector>

#include <crisp/error.hpp>
#include <crisp/registrar.hpp>

#include "plugins/calibrate/cloud_objective.hpp"
#include "plugins/calibrate/report.hpp"
#include "plugins/calibrate/rig_check.hpp"
#include "plugins/calibrate/rig_search.hpp"
#include "plugins/calibrate/single_beam_refusal.hpp"

namespace crisp::calibrate {
namespace {

void report_held(const std::vector<std::string>& names, std::string_view why, Context& context) {
  if (names.empty()) return;
  context.print(fmt::format("{} {} held: {}, and RQE does not determine {} (calibrate.refine estimates {})",
                            fmt::join(names, ", "), names.size() == 1 ? "is" : "are", why,
                            names.size() == 1 ? "it" : "them", names.size() == 1 ? "it" : "them"));
}

void report_not_estimated(const estimate::Outcome& outcome, Context& context) {
  std::vector<std::string> lags;
  std::vector<std::string> poses;
  for (const std::size_t parameter : outcome.not_estimated) {
    const std::string& name = outcome.model.names()[parameter];
    (name.ends_with(".eta") ? lags : poses).push_back(name);
  }
  report_held(poses, "the laser sees one side of the spin axis only", context);
  report_held(lags, "the entropy falls as far as the end of the lag's range", context);
}

}  // namespace

void RqeStage::describe(StageDescription<RqeStage>& d) {
  d.name("calibrate.rqe")
      .summary(
          "estimates lambda, tau, alpha and eta by minimizing the cloud's Rényi quadratic entropy (RQE)");
  d.details(
      "Self-calibration from the data alone (Sheehan, Harrison and Newman), in two steps. First the two beams of each laser that lie in the plate's plane, in the paper's order: each eta, each tau and alpha, each lambda around the whole circle. Then the whole field of view, with a decreasing kernel width. It starts from the rig's nominal values, or from those of a calibrate.load above. The standard errors include the ranges' noise; the bias of an entropy's optimum, some millimetres, is removed by calibrate.refine.\n\n"
      "A stationary plate is an error. A calibration with few plate angles, since the rates of plate and mirrors are commensurate (2 and 50 Hz, exactly), gets a caveat. The longest of several recordings (separated by pauses of 5 s) is used.");
  d.takes<Measurements>().holds<PlateTrajectory>().holds<Calibration>(Need::optional).gives<Calibration>();
  d.option("sigma", &RqeStage::sigma_,
           "kernel width for the whole field of view: first and last; start well above the noise")
      .unit("m")
      .range(1e-3, 10)
      .count(2, 2);
  d.option("in_plane_sigma", &RqeStage::in_plane_sigma_,
           "kernel width for the beams in the plate's plane: first and last")
      .unit("m")
      .range(1e-3, 10)
      .count(2, 2);
  d.option("in_plane_width", &RqeStage::settings_, &RqeCalibrationSettings::in_plane,
           &InPlaneSettings::half_width, "largest angle between a beam and the plate's plane")
      .unit("rad")
      .range(0, 0.1);
  d.option("full_field", &RqeStage::settings_, &RqeCalibrationSettings::full_field,
           "whether to continue with the whole field of view; the paper uses the two beams alone");
  d.option("points", &RqeStage::settings_, &RqeCalibrationSettings::points,
           "approximate number of points used, sampled evenly over the surfaces")
      .range(1000, 1e7);
  d.option("lambda_range", &RqeStage::range_, &estimate::ParameterPrior::lambda,
           "search range of lambda in one step; its start does not matter")
      .unit("rad")
      .range(1e-6, 3.2);
  d.option("tau_range", &RqeStage::range_, &estimate::ParameterPrior::tau,
           "search range of tau around its start")
      .unit("m")
      .range(1e-6, 10);
  d.option("alpha_range", &RqeStage::range_, &estimate::ParameterPrior::alpha,
           "search range of alpha around its start")
      .unit("rad")
      .range(1e-6, 1.5);
  d.option("eta_range", &RqeStage::range_, &estimate::ParameterPrior::eta,
           "search range of eta around its start")
      .unit("s")
      .range(1e-6, 1);
  d.option("fixed", &RqeStage::settings_, &RqeCalibrationSettings::fixed,
           "parameters that are held: laser1.eta, or eta for that of all lasers");
  d.option("noise", &RqeStage::settings_, &RqeCalibrationSettings::noise,
           "standard deviation of a range, for the standard errors")
      .unit("m")
      .range(1e-6, 1);
  d.option("measure", &RqeStage::measure_, "measure to minimize: rqe, or a plugin's");
  d.option("search", &RqeStage::measure_settings_, &MeasureSettings::search,
           "neighbour search: grid, flann, exact, or a plugin's");
  d.option("cutoff", &RqeStage::measure_settings_, &MeasureSettings::cutoff,
           "distance in kernel widths beyond which pairs are neglected")
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
      throw Error(std::string(name) + ": the kernel width must decrease", "write the larger sigma first");
    });
  };
  check_all(narrows(sigma_, "sigma"), narrows(in_plane_sigma_, "in_plane_sigma"),
            of_option("fixed", [&] { estimate::check_fixed(settings_.fixed, nominal_calibration(run.rig)); }),
            of_option("measure", [&] { make_measure(run); }));
}

void RqeStage::process(const Inputs& in, Outputs&, Context& context) {
  if (!start_) start_ = in.share<Calibration>();
  collected_.add(in.share<Measurements>(),
                 oriented_(in.share<PlateTrajectory>(), start_.get(), context.rig()));
}

Calibration RqeStage::compared_with_rig(Calibration calibration, Context& context) const {
  const RigCheck check = check_with_rig(calibration, context.rig(), range_);
  const bool finds_direction = context.rig().plate.direction == CountDirection::automatic && !start_;
  if (!start_) {
    if (auto turned = in_direction_of_rig(calibration, context.rig(), check)) {
      context.warn(kCountsClockwise);
      return std::move(*turned);
    }
  }
  note_direction(calibration, context.rig(), check);
  report_direction(calibration, {}, context);
  if (finds_direction && !check.knows_direction) {
    calibration.caveats.emplace_back(kDirectionIsOpen);
    context.mark_untrusted(calibration.caveats.back());
  }
  // Values that the data do not determine lie anywhere in their ranges: they show no mistake of the rig.
  const bool is_determined = calibration.unobservable.empty();
  for (const auto& caveat : check.caveats) {
    if (is_determined || !check.is_explained) context.mark_untrusted(caveat);
  }
  return calibration;
}

void RqeStage::finish(Outputs& out, Context& context) {
  estimate::Sample sample = estimate::longest_recording(collected_.sample());
  context.count("beams left out of the calibration of a long recording", collected_.left_out());
  RqeCalibrationSettings settings = settings_;
  settings.sigma_from = sigma_[0];
  settings.sigma_to = sigma_[1];
  settings.in_plane.sigma_from = in_plane_sigma_[0];
  settings.in_plane.sigma_to = in_plane_sigma_[1];
  settings.in_plane.range = range_;
  settings.in_plane.minimizer.interrupted = [&] { return context.interrupted(); };
  settings.seed = context.seed();
  const auto measure = make_measure(context.run());
  const auto& terms = context.run().registrar->get<TermRegistry>();
  const Calibration start = start_ ? *start_ : nominal_calibration(context.rig());
  refuse_single_beams(sample.beams, start, settings_.fixed);
  const bool finds_direction = context.rig().plate.direction == CountDirection::automatic && !start_;
  const auto search = [&](const auto& by) {
    return by(SensorModel(start, terms), sample, *measure, settings, context.rig(),
              [&](double done, std::string_view what) { context.progress(done, what); });
  };
  const auto [outcome, direction] = finds_direction ? search(search_in_both_directions)
                                                    : DirectedOutcome{.outcome = search(search_around_rig)};
  if (context.interrupted()) return;
  const bool is_reversed = direction == CountDirection::clockwise;
  const PlateTrajectory reversed = is_reversed ? data::reversed(*sample.plate) : PlateTrajectory();
  if (is_reversed) {
    context.warn(kCountsClockwise);
    sample.plate = &reversed;
  }

  for (const auto& caveat : outcome.caveats) context.mark_untrusted(caveat);
  for (const auto& minimum : outcome.other_minima) context.mark_untrusted(minimum);
  Calibration calibration = estimate::calibration_of(outcome, context.rig());
  if (is_reversed) calibration.direction = direction;
  calibration.caveats = outcome.caveats;  // of the data: no refinement answers them
  const double sigma = settings.full_field ? settings.sigma_to : settings.in_plane.sigma_to;
  const auto rqe = rqe_of({outcome.model, SensorModel(start, terms)}, sample,
                          {.sigma = sigma, .points = settings.points}, *measure);
  calibration.quality = {{"rqe_before", rqe[1]}, {"rqe_after", rqe[0]}, {"rqe_sigma", sigma}};
  calibration.provenance["calibration"] = "calibrate.rqe";
  calibration = compared_with_rig(std::move(calibration), context);
  constexpr double kByRounding = 1e-3;  // [nat] where hardly anything is determined
  if (calibration.quality.at("rqe_after") > calibration.quality.at("rqe_before") + kByRounding) {
    context.mark_untrusted(
        "the calibration increased the cloud's Rényi quadratic entropy: it is worse than its start");
  }
  if (outcome.free.empty()) context.mark_untrusted("RQE determines none of the parameters");
  report_not_estimated(outcome, context);
  report(calibration, {}, context);
  context.print(
      "standard errors include the ranges' noise, but not the bias of RQE's optimum of some millimetres and tenths of a degree, or some degrees for lasers that see one side, which calibrate.refine removes");
  out.give(std::move(calibration));
}

}  // namespace crisp::calibrate
