// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/assemble/deskew_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <crisp/deskew.hpp>
#include <crisp/error.hpp>
#include <crisp/registrar.hpp>

#include "pipeline/model/terms_in.hpp"

namespace crisp::assemble {
namespace {

constexpr double kWorthAWarning = 0.01;  // share of the beams that are missing from the cloud

}  // namespace

void DeskewStage::describe(StageDescription<DeskewStage>& d) {
  d.name("assemble.deskew")
      .summary("assembles the cloud: places each beam at the plate's angle of its firing time");
  d.details(
      "Each beam has a firing time of its own: the plate's angle is interpolated at that time, shifted by the laser's lag, and the sensor model places the beam with the parameters of its laser. The points are in the plate's frame.\n\n"
      "The calibration is that of the nearest stage above that gives one: `calibrate.load` for a known one, or a stage that estimates it, for which the measurements are buffered until it is done. Without such a stage the rig's nominal values apply.\n\n"
      "Beams without an encoder reading around their firing time (before the first, after the last, in a silence longer than the clock stage's `max_gap`) are dropped and counted; nothing is extrapolated. To assemble only some lasers or ranges, put a `filter.range` above.");
  d.takes<Measurements>().holds<PlateTrajectory>().holds<Calibration>(Need::optional).gives<Cloud>();
}

void DeskewStage::process(const Inputs& in, Outputs& out, Context& context) {
  const auto& beams = in.get<Measurements>();
  const SensorModel& placing = model(in.share<Calibration>(), context.run());
  const auto plate = oriented_(in.share<PlateTrajectory>(), calibration_.get(), context.rig());
  Deskewed deskewed = deskew(beams, *plate, placing, mirrors_, clouds_.get());
  if (beams.cos_incidence.empty()) blind_ = with_incidence_;
  beams_ += beams.size();
  outside_ += deskewed.outside;
  context.count("beams outside the encoder readings", deskewed.outside);
  out.give(std::move(deskewed.cloud));
}

const SensorModel& DeskewStage::model(std::shared_ptr<const Calibration> calibration,
                                      const RunSettings& run) {
  if (!model_ || calibration != calibration_) {
    model_.emplace(calibration ? *calibration : nominal_calibration(run.rig),
                   run.registrar->get<TermRegistry>());
    with_incidence_ = model::terms_in(model_->calibration(), run.registrar->get<TermRegistry>(),
                                      &TermInfo::needs_incidence);
    calibration_ = std::move(calibration);
  }
  return *model_;
}

void DeskewStage::finish(Outputs&, Context& context) {
  const std::uint64_t points = beams_ - outside_;
  if (beams_ > 0 && points == 0) {
    throw Error(
        fmt::format("none of {} beams could be placed: no encoder readings cover their times", beams_),
        "check that the encoder was recorded together with the lasers");
  }
  const bool nominal = calibration_ == nullptr;
  context.report({{"beams", beams_}, {"points", points}, {"calibration", nominal ? "nominal" : "given"}});
  context.print(fmt::format("{} points of {} beams, placed by {}", points, beams_,
                            nominal ? "the rig's nominal values" : "the calibration"));
  if (!blind_.empty()) {
    context.warn(fmt::format("the cloud is placed without {}: the incidence angles of its beams are unknown",
                             fmt::join(blind_, ", ")));
  }
  const double missing =
      static_cast<double>(outside_) / static_cast<double>(std::max<std::uint64_t>(beams_, 1));
  if (missing > kWorthAWarning) {
    context.warn(fmt::format(
        "{:.1f} % of the beams are not in the cloud: no encoder readings cover their firing times",
        100 * missing));
  }
}

}  // namespace crisp::assemble
