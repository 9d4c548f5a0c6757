// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/assemble/deskew_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "pipeline/data/error.hpp"
#include "pipeline/model/terms_in.hpp"
#include "pipeline/stage/registry.hpp"
#include "plugins/assemble/deskew.hpp"

namespace crisp {
namespace {

constexpr double kWorthAWarning = 0.01;  // share of the beams that are missing from the cloud

}  // namespace

void DeskewStage::describe(StageDescription<DeskewStage>& d) {
  d.name("assemble.deskew").summary("places each beam where the plate was when it was fired");
  d.details(
      "Each beam has an instant of its own: the plate's angle is interpolated at that instant, shifted by "
      "the "
      "laser's lag, and the beam placed by the sensor's model with the parameters of its laser. The points "
      "are in the plate's frame.\n\n"
      "The calibration is that of the nearest stage above that gives one: `calibrate.load` for a known one, "
      "or a stage that estimates it, for which the measurements are kept until it is done. Without such a "
      "stage the rig's nominal values are taken.\n\n"
      "Beams that were fired when the plate's readings do not say where it was (before the first, after the "
      "last, in a silence longer than the clock stage's `max_gap`) are left out and counted; nothing is "
      "extrapolated. To assemble only some lasers or ranges, put a `filter.range` above.");
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
  context.count("beams outside the plate's readings", deskewed.outside);
  out.give(std::move(deskewed.cloud));
}

const SensorModel& DeskewStage::model(std::shared_ptr<const Calibration> calibration,
                                      const RunSettings& run) {
  if (!model_ || calibration != calibration_) {
    model_.emplace(calibration ? *calibration : nominal_calibration(run.rig),
                   run.registrar->get<TermRegistry>());
    with_incidence_ =
        terms_in(model_->calibration(), run.registrar->get<TermRegistry>(), &TermInfo::needs_incidence);
    calibration_ = std::move(calibration);
  }
  return *model_;
}

void DeskewStage::finish(Outputs&, Context& context) {
  const std::uint64_t points = beams_ - outside_;
  if (beams_ > 0 && points == 0) {
    throw Error(
        fmt::format("none of {} beams could be placed: the plate's readings do not say where it was", beams_),
        "see whether they were recorded all the time");
  }
  const bool nominal = calibration_ == nullptr;
  context.report({{"beams", beams_}, {"points", points}, {"calibration", nominal ? "nominal" : "given"}});
  context.say(fmt::format("{} points of {} beams, placed by {}", points, beams_,
                          nominal ? "the rig's nominal values" : "the calibration"));
  if (!blind_.empty()) {
    context.warn(
        fmt::format("the cloud is placed without {}: nobody has found how its beams met their surfaces",
                    fmt::join(blind_, ", ")));
  }
  const double missing =
      static_cast<double>(outside_) / static_cast<double>(std::max<std::uint64_t>(beams_, 1));
  if (missing > kWorthAWarning) {
    context.warn(
        fmt::format("{:.1f} % of the beams are not in the cloud: the plate's readings do not say "
                    "where it was when they were fired",
                    100 * missing));
  }
}

}  // namespace crisp
