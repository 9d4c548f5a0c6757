// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/mounting_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/rig_echoes.hpp"

namespace crisp::diagnose {
namespace {

using data::kDegree;

constexpr double kShortestSweep = 5 * kDegree;
constexpr double kInjectedOffset = 0.03;  // [m]

/// Fit with one window size and one set of free parameters.
struct MountingTry {
  double side = 0;
  bool with_offset = false;
  MountingFit fit;
  std::vector<double> recovered = {};  ///< recovered share of an injected error, per parameter
};

/// Range of one parameter's estimates over all fits.
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
      why = fmt::format("its standard error of {:.0f} mm is too large for a mounting of centimetres",
                        1e3 * error);
    }
    if (!agrees()) {
      why += std::string(why.empty() ? "" : ", and ") +
             "its estimates differ between window sizes or with a range offset";
    }
    return why;
  }
  static constexpr double kOfUse = 0.02;  // [m] largest useful standard error
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

/// Injection test: recovered share of an injected error.
double recovered_share(const std::vector<FlatWindow>& windows, MountingParameter parameter,
                       const MountingFit& before, const std::vector<MountingParameter>& free) {
  const auto after = fit_mounting(with_injected(windows, parameter, kInjectedOffset), {}, free, 1);
  return (after.values[parameter] - before.values[parameter]) / kInjectedOffset;
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
      "  windows of {:.0f} deg: {:3} flat, {:6} beams, rms {:5.1f} mm: along the beam {:+7.1f} ± {:5.1f} mm, along the normal {:+7.1f} ± {:5.1f} mm",
      each.side / kDegree, fit.windows, fit.beams, 1e3 * fit.rms, 1e3 * fit.values[kAlongBeam],
      1e3 * fit.std_errors[kAlongBeam], 1e3 * fit.values[kAlongNormal], 1e3 * fit.std_errors[kAlongNormal]);
  if (each.with_offset) {
    text += fmt::format(", ranges {:+.1f} ± {:.1f} mm", 1e3 * fit.values[kRangeOffset],
                        1e3 * fit.std_errors[kRangeOffset]);
  }
  text += fmt::format("; recovered share of 30 mm injected: {:.2f} along the beam, {:.2f} along the normal",
                      each.recovered[kAlongBeam], each.recovered[kAlongNormal]);
  return each.with_offset ? text + fmt::format(", {:.2f} in the ranges", each.recovered[kRangeOffset]) : text;
}

}  // namespace

void DiagnoseMountingStage::describe(StageDescription<DiagnoseMountingStage>& d) {
  d.name("diagnose.mounting")
      .summary("tests whether a sweep identifies the offset of the optical centre from the axis");
  d.details(
      "For one laser whose scan plane contains the actuator's axis (alpha = -90deg). The stage cuts the sweep into windows of neighbouring scans and beams and keeps the flat ones. Each window has its own optical centre in that selection, so that the selection does not favour any value. Least squares in the ranges then estimate the optical centre in the fan's plane and along its normal, with a plane per window. The fit runs with and without a common range offset, for several window sizes.\n\n"
      "A coordinate is determined if all fits agree within their errors (bootstrap over windows). Otherwise it is reported as unobservable, with the range of its estimates: real surfaces and real ranges deviate by more than noise, which formal errors do not include.");
  d.takes<Scan>().takes<PlateReading>();
  d.takes<Findings>(Need::optional).gives<Findings>();
  d.option("sides", &DiagnoseMountingStage::sides_, "window sizes; if empty: 8, 12, 16 and 24 degrees")
      .unit("rad")
      .range(0.01, 2);
}

void DiagnoseMountingStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) findings_.append(*before);
  if (const auto* reading = in.find<PlateReading>()) series_.add(*reading);
  if (auto scan = in.share<Scan>(); scan && scan->laser == 0)
    series_.add(data::with_used_echoes(std::move(scan), context.rig()));
}

void DiagnoseMountingStage::diagnose(Findings& findings, Context& context) const {
  const auto& laser = context.rig().lasers.front();
  const auto passes = find_passes(series_, series_.actuator(context.rig().plate), kShortestSweep);
  const Pass* sweep = longest(passes);
  const auto nothing = [&](const std::string& why) {
    findings.unobservable.push_back({laser.name + ".tau", why, ""});
    context.print(laser.name + ": " + why);
  };
  if (sweep == nullptr) return nothing("the recording has no sweep");
  const Scan& first = *series_.scans().front().scan;
  const FanGeometry fan{.first = first.start_angle - laser.mount, .step = first.angle_step};
  const std::vector<double> usual = {8 * kDegree, 12 * kDegree, 16 * kDegree, 24 * kDegree};
  std::vector<MountingTry> tries;
  std::string lines;
  auto report = nlohmann::json::array();
  for (const double side : sides_.empty() ? usual : sides_) {
    const auto windows = flat_windows(*sweep, fan, side);
    constexpr std::size_t kMinWindows = 6;
    if (windows.size() < kMinWindows || context.interrupted()) continue;
    for (const bool with_offset : {false, true}) {
      std::vector<MountingParameter> free = {kAlongBeam, kAlongNormal};
      if (with_offset) free.push_back(kRangeOffset);
      MountingTry each{
          .side = side, .with_offset = with_offset, .fit = fit_mounting(windows, {}, free, context.seed())};
      for (const auto parameter : free)
        each.recovered.push_back(recovered_share(windows, parameter, each.fit, free));
      lines += "\n" + line_of(each);
      const bool is_worse = with_offset && each.fit.rms > tries.back().fit.rms;
      if (is_worse) lines += "; diverged: the fit is worse than without the offset";
      report.push_back({{"side", side},
                        {"with_offset", with_offset},
                        {"windows", each.fit.windows},
                        {"values", each.fit.values},
                        {"std_errors", each.fit.std_errors},
                        {"answers", each.recovered}});
      tries.push_back(each);
    }
  }
  if (tries.empty()) return nothing("too few windows of the sweep are flat to estimate the optical centre");
  context.print(laser.name + ": offset of the optical centre from the axis" + lines);
  context.report({{laser.name, report}});
  for (const auto& [parameter, name, cause] :
       {std::tuple(kAlongBeam, "along the middle beam", ".tau"),
        std::tuple(kAlongNormal, "along the fan's normal", ".mount.tangential_offset")}) {
    const Agreed all = agreed(tries, parameter);
    const std::string range = fmt::format("{:+.0f} to {:+.0f} mm, standard errors up to {:.0f} mm",
                                          1e3 * all.low, 1e3 * all.high, 1e3 * all.error);
    context.print(
        fmt::format("  {}: {}, {}", name, all.determined() ? "determined" : "not determined", range));
    if (all.determined()) continue;
    findings.unobservable.push_back(
        {laser.name + cause, fmt::format("{}: {} {}", all.why_not(), name, range), ""});
  }
}

void DiagnoseMountingStage::finish(Outputs& out, Context& context) {
  if (series_.scans().empty()) throw no_actuated_scans();
  diagnose(findings_, context);
  if (!context.interrupted()) out.give(std::move(findings_));
}

}  // namespace crisp::diagnose
