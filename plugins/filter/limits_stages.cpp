// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/filter/limits_stages.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <crisp/error.hpp>

#include "pipeline/files/nearest.hpp"

namespace crisp::filter {
namespace {

template <class Declaration>
void as_limits(Declaration declaration, const char* unit, double most) {
  declaration.unit(unit).range(-most, most).count(0, 2);
}

}  // namespace

void CropStage::describe(StageDescription<CropStage>& d) {
  d.name("filter.crop").summary("keeps points within a box, or within limits of distance");
  d.details(
      "Each limit is a list of the smallest and the largest value: `z: [-1m, 2m]`. Without a limit, all values are kept.");
  d.takes<Cloud>().gives<Cloud>();
  as_limits(d.option("x", &CropStage::limits_, &CropLimits::x, "limits of x in the plate's frame"), "m", 1e6);
  as_limits(d.option("y", &CropStage::limits_, &CropLimits::y, "limits of y in the plate's frame"), "m", 1e6);
  as_limits(d.option("z", &CropStage::limits_, &CropLimits::z, "limits of z in the plate's frame"), "m", 1e6);
  as_limits(d.option("distance", &CropStage::limits_, &CropLimits::distance,
                     "limits of the distance from the plate's centre"),
            "m", 1e6);
}

void CropStage::check(const RunSettings&) const {
  const auto right = [](const auto& limits, const char* name) {
    return of_option(name, [&limits, name] { check_limits(limits, name); });
  };
  check_all(right(limits_.x, "x"), right(limits_.y, "y"), right(limits_.z, "z"),
            right(limits_.distance, "distance"));
}

void CropStage::process(const Inputs& in, Outputs& out, Context& context) {
  const Cloud& cloud = in.get<Cloud>();
  Cloud kept = crop(cloud, limits_);
  context.count("points outside the limits", cloud.size() - kept.size());
  all_ += cloud.size();
  kept_ += kept.size();
  out.give(std::move(kept));
}

void CropStage::finish(Outputs&, Context& context) {
  context.print(fmt::format("kept {} of {} points", kept_, all_));
}

void RangeStage::describe(StageDescription<RangeStage>& d) {
  constexpr double kTurn = 6.3;
  d.name("filter.range")
      .summary(
          "keeps the measurements within limits of range, mirror angle and remission, or of some lasers");
  d.details(
      "Before calibration or assembly: removes beams on the scanner itself, or one laser. Each limit is a list of the smallest and the largest value: `range: [0.3m, 30m]`.");
  d.takes<Measurements>().gives<Measurements>();
  as_limits(d.option("range", &RangeStage::range_, "limits of the range"), "m", 1e6);
  as_limits(d.option("mirror_angle", &RangeStage::mirror_angle_,
                     "limits of the mirror's angle, relative to the mount"),
            "rad", kTurn);
  as_limits(d.option("remission", &RangeStage::remission_,
                     "limits of the remission, in the device's units; 0 where the device sends none"),
            "1", 1e6);
  d.option("lasers", &RangeStage::lasers_, "names of the lasers to keep; none: all");
}

void RangeStage::check(const RunSettings& run) const {
  check_all(of_option("range", [&] { check_limits(range_, "range"); }),
            of_option("mirror_angle", [&] { check_limits(mirror_angle_, "mirror_angle"); }),
            of_option("remission", [&] { check_limits(remission_, "remission"); }),
            of_option("lasers", [&] { limits(run.rig); }));
}

RangeLimits RangeStage::limits(const Rig& rig) const {
  RangeLimits limits{.range = range_, .mirror_angle = mirror_angle_, .remission = remission_};
  std::vector<std::string> known;
  for (const auto& laser : rig.lasers) known.push_back(laser.name);
  for (const auto& name : lasers_) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw Error("the rig has no laser '" + name + "'",
                  files::did_you_mean(name, known, "see the rig's file"));
    }
    limits.lasers.push_back(static_cast<unsigned>(found - known.begin()));
  }
  return limits;
}

void RangeStage::process(const Inputs& in, Outputs& out, Context& context) {
  const auto& beams = in.get<Measurements>();
  Measurements kept = within(beams, limits(context.rig()));
  context.count("measurements outside the limits", beams.size() - kept.size());
  all_ += beams.size();
  kept_ += kept.size();
  out.give(std::move(kept));
}

void RangeStage::finish(Outputs&, Context& context) {
  context.print(fmt::format("kept {} of {} measurements", kept_, all_));
}

}  // namespace crisp::filter
