// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/mounting_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

constexpr double kShortestSweep = 5 * kDegree;
constexpr double kPutInMounting = 0.03;  // [m]

/// One choice of windows and of what is free beside the centre.
struct MountingTry {
  double side = 0;
  bool with_offset = false;
  MountingFit fit;
  std::vector<double> answers = {};  ///< share of what is put in by hand that comes back, of each parameter
};

/// What all tries say of a parameter.
struct Agreed {
  double low = 0, high = 0;  ///< [m] of the values
  double error = 0;          ///< [m] the largest standard error
  bool determined() const { return is_sharp() && agrees(); }
  bool is_sharp() const { return error < kOfUse; }
  bool agrees() const {
    constexpr double kApart = 3;  // standard errors
    return high - low < kApart * error;
  }
  std::string why_not() const {
    std::string why;
    if (!is_sharp()) {
      why = fmt::format("its standard error of {:.0f} mm tells nothing of a mounting of centimetres",
                        1e3 * error);
    }
    if (!agrees()) {
      why += std::string(why.empty() ? "" : ", and ") +
             "it depends on which windows count and on whether ranges may be off";
    }
    return why;
  }
  static constexpr double kOfUse = 0.02;  // [m]
};

Agreed agreed(const std::vector<MountingTry>& tries, MountingParameter parameter) {
  Agreed all{.low = tries.front().fit.values[parameter], .high = all.low};
  for (const auto& each : tries) {
    all.low = std::min(all.low, each.fit.values[parameter]);
    all.high = std::max(all.high, each.fit.values[parameter]);
    all.error = std::max(all.error, each.fit.std_errors[parameter]);
  }
  return all;
}

/// How much of a change put in by hand comes back.
double answer_of(const std::vector<FlatWindow>& windows, MountingParameter parameter,
                 const MountingFit& before, const std::vector<MountingParameter>& free) {
  const auto after = fit_mounting(with_put_in(windows, parameter, kPutInMounting), {}, free, 1);
  return (after.values[parameter] - before.values[parameter]) / kPutInMounting;
}

const Pass* longest(const std::vector<Pass>& passes) {
  const auto most = std::max_element(passes.begin(), passes.end(), [](const Pass& a, const Pass& b) {
    return a.scans.size() < b.scans.size();
  });
  return most == passes.end() ? nullptr : &*most;
}

std::string line_of(const MountingTry& each) {
  const auto& fit = each.fit;
  std::string text = fmt::format(
      "  windows of {:.0f} deg: {:3} flat, {:6} beams, rms {:5.1f} mm: along the beam {:+7.1f} ± {:5.1f} mm, "
      "along the "
      "normal {:+7.1f} ± {:5.1f} mm",
      each.side / kDegree, fit.windows, fit.beams, 1e3 * fit.rms, 1e3 * fit.values[kAlongBeam],
      1e3 * fit.std_errors[kAlongBeam], 1e3 * fit.values[kAlongNormal], 1e3 * fit.std_errors[kAlongNormal]);
  if (each.with_offset) {
    text += fmt::format(", ranges {:+.1f} ± {:.1f} mm", 1e3 * fit.values[kRangeOffset],
                        1e3 * fit.std_errors[kRangeOffset]);
  }
  text += fmt::format("; 30 mm put in: {:.2f} times along the beam, {:.2f} along the normal",
                      each.answers[kAlongBeam], each.answers[kAlongNormal]);
  return each.with_offset ? text + fmt::format(", {:.2f} of the ranges", each.answers[kRangeOffset]) : text;
}

}  // namespace

void DiagnoseMountingStage::describe(StageDescription<DiagnoseMountingStage>& d) {
  d.name("diagnose.mounting")
      .summary("asks whether a sweep tells where the optical centre lies off the axis");
  d.details(
      "For one laser whose scan plane holds the actuator's axis (alpha = -90deg). The sweep is cut into "
      "windows of "
      "neighbouring scans and beams; those that are flat count, each with a plane of its own, and with an "
      "offset of its "
      "own while it is chosen, so that the choice prefers no answer. The optical centre's two coordinates in "
      "the fan's "
      "plane and along its normal are then found by least squares in the ranges of all windows, once alone "
      "and once with "
      "an offset of all ranges, for several sizes of windows.\n\n"
      "A coordinate is determined only if all of these agree within their errors (a bootstrap over windows). "
      "If not, it "
      "is called unobservable, with the values that it took: real surfaces and real ranges bend by more than "
      "the noise, "
      "and a formal error does not know that.");
  d.takes<Scan>().takes<PlateReading>();
  d.takes<Findings>(Need::optional).gives<Findings>();
  d.option("sides", &DiagnoseMountingStage::sides_, "sizes of the windows; none: 8, 12, 16 and 24 degrees")
      .unit("rad")
      .range(0.01, 2);
}

void DiagnoseMountingStage::process(const Inputs& in, Outputs&, Context&) {
  if (const Findings* before = in.find<Findings>()) findings_.append(*before);
  if (const auto* reading = in.find<PlateReading>()) series_.add(*reading);
  if (auto scan = in.share<Scan>(); scan && scan->laser == 0) series_.add(std::move(scan));
}

void DiagnoseMountingStage::diagnose(Findings& findings, Context& context) const {
  const auto& laser = context.rig().lasers.front();
  const auto passes = find_passes(series_, series_.actuator(context.rig().plate), kShortestSweep);
  const Pass* sweep = longest(passes);
  const auto nothing = [&](const std::string& why) {
    findings.unobservable.push_back({laser.name + ".tau", why, ""});
    context.say(laser.name + ": " + why);
  };
  if (sweep == nullptr) return nothing("there is no sweep");
  const Scan& first = *series_.scans().front().scan;
  const FanGeometry fan{.first = first.start_angle - laser.mount, .step = first.angle_step};
  const std::vector<double> usual = {8 * kDegree, 12 * kDegree, 16 * kDegree, 24 * kDegree};
  std::vector<MountingTry> tries;
  std::string lines;
  auto report = nlohmann::json::array();
  for (const double side : sides_.empty() ? usual : sides_) {
    const auto windows = flat_windows(*sweep, fan, side);
    constexpr std::size_t kFewestWindows = 6;
    if (windows.size() < kFewestWindows || context.interrupted()) continue;
    for (const bool with_offset : {false, true}) {
      std::vector<MountingParameter> free = {kAlongBeam, kAlongNormal};
      if (with_offset) free.push_back(kRangeOffset);
      MountingTry each{
          .side = side, .with_offset = with_offset, .fit = fit_mounting(windows, {}, free, context.seed())};
      for (const auto parameter : free) each.answers.push_back(answer_of(windows, parameter, each.fit, free));
      lines += "\n" + line_of(each);
      const bool is_worse = with_offset && each.fit.rms > tries.back().fit.rms;
      if (is_worse) lines += "; no fit: it ran away to where it is worse than without the offset";
      report.push_back({{"side", side},
                        {"with_offset", with_offset},
                        {"windows", each.fit.windows},
                        {"values", each.fit.values},
                        {"std_errors", each.fit.std_errors},
                        {"answers", each.answers}});
      tries.push_back(each);
    }
  }
  if (tries.empty())
    return nothing("too few windows of the sweep are flat to tell where the optical centre lies");
  context.say(laser.name + ": the optical centre off the axis" + lines);
  context.report({{laser.name, report}});
  for (const auto& [parameter, name, cause] :
       {std::tuple(kAlongBeam, "along the middle beam", ".tau"),
        std::tuple(kAlongNormal, "along the fan's normal", ".mount.tangential_offset")}) {
    const Agreed all = agreed(tries, parameter);
    const std::string range = fmt::format("{:+.0f} to {:+.0f} mm with errors up to {:.0f} mm", 1e3 * all.low,
                                          1e3 * all.high, 1e3 * all.error);
    context.say(fmt::format("  {}: {}, {}", name, all.determined() ? "determined" : "not determined", range));
    if (all.determined()) continue;
    findings.unobservable.push_back(
        {laser.name + cause, fmt::format("{}: {} {}", all.why_not(), name, range), ""});
  }
}

void DiagnoseMountingStage::finish(Outputs& out, Context& context) {
  if (series_.scans().empty()) throw Error("no scans with readings of an actuator came");
  diagnose(findings_, context);
  if (!context.interrupted()) out.give(std::move(findings_));
}

}  // namespace crisp
