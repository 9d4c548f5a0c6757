// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/passes_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/rig_echoes.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "plugins/diagnose/scans/homogeneity_test.hpp"
#include "plugins/diagnose/scans/pass_fit_test.hpp"

namespace crisp::diagnose {
namespace {

using data::kDegree;

constexpr double kStandsOut = 3;         // standard errors
constexpr double kInhomogeneous = 0.01;  // p-value below which the shift is not homogeneous

/// The longest pass in either direction, up first; empty if one is missing.
std::optional<std::pair<Pass, Pass>> opposite(const std::vector<Pass>& passes) {
  const auto longest = [&](bool up) -> const Pass* {
    const Pass* best = nullptr;
    for (const auto& pass : passes) {
      if (pass.up == up && (best == nullptr || pass.scans.size() > best->scans.size())) best = &pass;
    }
    return best;
  };
  const Pass* up = longest(true);
  const Pass* down = longest(false);
  if (up == nullptr || down == nullptr) return {};
  return std::pair(*up, *down);
}

/// The formatted number, or "unknown" if it is not finite.
std::string shown(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "unknown";
}

std::string in_degrees(const std::vector<std::pair<double, double>>& values) {
  std::string text;
  for (const auto& [value, error] : values) {
    text += fmt::format("{}{} ± {}", text.empty() ? "" : ", ", shown(value / kDegree, "{:+.3f}"),
                        shown(error / kDegree, "{:.3f}"));
  }
  return text;
}

}  // namespace

std::string in_words(const std::string& laser, const PassOffset& found, double step, std::size_t beams) {
  std::string recovered_shifts;
  for (const auto& [injected, recovered] : found.recovered_shifts) {
    recovered_shifts += fmt::format("{}{:+.4f}: {}", recovered_shifts.empty() ? "" : ", ", injected / kDegree,
                                    shown(recovered / kDegree, "{:+.4f}"));
  }
  const Gain& gain = found.gain;
  return fmt::format(
      "{}: downward pass shifted by {} ± {} deg ({} steps) against the upward pass, ranges by {} mm, over {} beams\n"
      "  quarters of the angles: {} deg; of the beams: {} deg; homogeneity p = {}\n"
      "  on held-out angles the passes differ by {} -> {} mm (change {} .. {})\n"
      "  injected: recovered [deg]: {}; regression slope {}",
      laser, shown(found.shift / kDegree, "{:+.4f}"), shown(found.std_error / kDegree, "{:.4f}"),
      shown(found.shift / step, "{:.2f}"), shown(1e3 * found.offset, "{:+.1f}"), beams,
      in_degrees(found.by_angle), in_degrees(found.by_beam), shown(found.constant_p, "{:.3g}"),
      shown(1e3 * gain.before, "{:.2f}"), shown(1e3 * gain.after, "{:.2f}"),
      shown(1e3 * gain.ci95[0], "{:.2f}"), shown(1e3 * gain.ci95[1], "{:.2f}"), recovered_shifts,
      shown(found.recovery_slope, "{:.3f}"));
}

namespace {

void report(const std::string& laser, const PassOffset& found, double step, std::size_t beams,
            Context& context) {
  context.print(in_words(laser, found, step, beams));
  context.report({{laser,
                   {{"shift", found.shift},
                    {"std_error", found.std_error},
                    {"steps", found.shift / step},
                    {"offset", found.offset},
                    {"constant_p", found.constant_p},
                    {"by_angle", found.by_angle},
                    {"by_beam", found.by_beam},
                    {"answers", found.recovered_shifts},
                    {"answer_ratio", found.recovery_slope}}}});
}

/// Whether the injection test recovers the injected shifts, so that the estimate is credible.
bool is_credible(const PassOffset& found) {
  constexpr double kWithin = 0.1;
  return std::isfinite(found.shift) && found.std_error > 0 && std::abs(found.recovery_slope - 1) <= kWithin;
}

bool stands_out(const PassOffset& found) { return std::abs(found.shift) >= kStandsOut * found.std_error; }

/// Reports the shift as a finding if it is homogeneous and credible; otherwise as unnamed or unobservable.
void add_findings(const std::string& laser, const PassOffset& found, Findings& findings) {
  if (!is_credible(found)) {
    findings.unobservable.push_back(
        {"encoder.backlash",
         fmt::format(
             "{}: the estimator does not recover injected shifts between the passes; the estimate was {} deg, with a standard error of {} deg",
             laser, shown(found.shift / kDegree, "{:+.3f}"), shown(found.std_error / kDegree, "{:.3f}")),
         ""});
    return;
  }
  if (!stands_out(found)) return;
  const bool generalizes = found.gain.significant_decrease();
  if (found.constant_p < kInhomogeneous) {
    findings.unnamed.push_back({.covariate = "direction of the actuator, inhomogeneous over its angles",
                                .quantity = "plate angle",
                                .scope = "plate",
                                .amplitude = std::abs(found.shift) / 2,
                                .unit = "rad",
                                .p_value = found.constant_p,
                                .gain = {found.gain},
                                .accepted = generalizes});
    return;
  }
  Finding finding{.cause = "encoder.backlash", .scope = "plate"};
  finding.parameters = {{"delta", "rad", -found.shift / 2, found.std_error / 2, true}};
  finding.explained_fraction = found.gain.explained();
  const HomogeneityTest none = homogeneity_test({{found.shift, found.std_error}}, Level::kZero, kPassBlocks);
  finding.log10_bayes_factor =
      none.log10_bayes_factor;  // a lag is equally likely, and is listed as confounded
  finding.p_value = none.p_value;
  finding.confounded_with = {laser + ".eta"};
  finding.resolvable_by = {
      "passes at another speed: backlash is constant, the shift by a lag grows with the speed"};
  finding.gain = {found.gain};
  finding.accepted = generalizes;
  findings.findings.push_back(std::move(finding));
}

/// Removes half of the shift from the angles of either direction.
PlateTrajectory without_offset(const PlateTrajectory& plate, double shift) {
  const auto angles = plate.angles();
  std::vector<double> moved(angles.begin(), angles.end());
  double direction = 0;
  for (std::size_t i = angles.size(); i-- > 0;) {  // backwards: the next motion determines the direction …
    if (i + 1 < angles.size() && angles[i + 1] != angles[i]) direction = angles[i + 1] > angles[i] ? 1 : -1;
    moved[i] -= direction * shift / 2;
  }
  for (std::size_t i = 1; i < angles.size() && angles[i] != angles[i - 1]; ++i) {
    // … and a stationary end takes it from the previous motion
    moved[i] = angles[i] - (angles[i] > angles[i - 1] ? 1 : -1) * shift / 2;
  }
  return plate.with_angles(std::move(moved));
}

/// The estimated shift, with ± 2 standard errors.
plot::PlotMark mark_of(const PassOffset& found) {
  return {
      .at = found.shift / kDegree,
      .around = std::isfinite(found.std_error) ? 2 * found.std_error / kDegree : 0,
      .name = fmt::format("{}: {:+.3f} ± {} deg", is_credible(found) ? "estimate" : "estimate, not credible",
                          found.shift / kDegree, shown(found.std_error / kDegree, "{:.3f}"))};
}

void draw(const std::filesystem::path& folder, const std::string& laser, const PassComparison& comparison,
          const PassOffset& found, Context& context) {
  plot::Plot plot{.title = laser + ": downward against upward pass",
                  .x_label = "shift between the passes [deg]",
                  .y_label = "standard deviation of the differences [mm]",
                  .marks = {mark_of(found)}};
  std::vector<std::size_t> all;
  for (std::size_t b = 0; b < comparison.blocks.size(); ++b) all.push_back(b);
  constexpr std::size_t kQuarters = 4;
  for (std::size_t q = 0; q <= kQuarters; ++q) {
    std::vector<std::size_t> some;
    for (const auto b : all) {
      if (q == kQuarters || comparison.blocks[b].angle_part * kQuarters / kAngleParts == q) some.push_back(b);
    }
    plot::PlotSeries series{.name = q == kQuarters ? "all" : fmt::format("quarter {} of the angles", q + 1)};
    for (int k = -kReach; k <= kReach; ++k) {
      series.x.push_back(k * comparison.step / kDegree);
      series.y.push_back(1e3 * std::sqrt(variance_at(comparison, some, k * comparison.step)));
    }
    plot.series.push_back(std::move(series));
  }
  plot::write_plots(folder / (laser + "_passes.svg"), {plot}, context);
}

}  // namespace

void DiagnosePassesStage::describe(StageDescription<DiagnosePassesStage>& d) {
  d.name("diagnose.passes").summary("tests a reversing actuator for hysteresis between its directions");
  d.details(
      "For a laser on an actuator that sweeps up and down. The stage compares each beam of the downward pass with those of the upward pass at nearby angles, and estimates the shift that minimizes the variance of the range differences. Unlike a regression on measured slopes, this estimate has no attenuation bias by noise. An injection test of known shifts validates it.\n\n"
      "Backlash (`encoder.backlash`) and a lag between the clocks are confounded if both passes have the same speed, so both are named. A shift that differs between angles is reported as `unnamed`. The output measurements have half of the shift removed from either direction, since the data do not identify which direction is right.");
  d.takes<Scan>().takes<PlateReading>().takes<Measurements>().holds<PlateTrajectory>();
  d.takes<Findings>(Need::optional).gives<Findings>().gives<PlateTrajectory>().gives<Measurements>();
  d.option("min_pass", &DiagnosePassesStage::shortest_, "minimum travel of a pass")
      .unit("rad")
      .range(1e-4, 1e4);
  d.option("correct", &DiagnosePassesStage::correct_,
           "whether to correct the angles of the returned trajectory");
  d.option("folder", &DiagnosePassesStage::folder_, "folder for plots of the comparison; auto: no plots")
      .writes_into({"*_passes.svg"});
}

void DiagnosePassesStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) findings_.append(*before);
  if (auto plate = in.share<PlateTrajectory>()) plate_ = std::move(plate);
  if (const auto* reading = in.find<PlateReading>()) series_.add(*reading);
  if (auto scan = in.share<Scan>(); scan && scan->laser == 0)
    series_.add(data::with_used_echoes(std::move(scan), context.rig()));
  if (auto beams = in.share<Measurements>()) beams_.push_back(std::move(beams));
}

double DiagnosePassesStage::diagnose(Findings& findings, Context& context) const {
  const std::string& name = context.rig().lasers.front().name;
  const auto actuator = series_.actuator(context.rig().plate);
  const auto skip = [&](const std::string& why) {
    findings.unobservable.push_back({"encoder.backlash", fmt::format("{}: {}", name, why), ""});
    context.print(name + ": passes cannot be compared, since " + why);
    return 0.0;
  };
  const auto passes = find_passes(series_, actuator, shortest_);
  if (passes.empty()) {
    return skip(
        fmt::format("the actuator has no pass of at least {:g} deg in one direction", shortest_ / kDegree));
  }
  const auto both = opposite(passes);
  if (!both) return skip("the actuator moves in one direction only");
  const auto& [up, down] = *both;
  const auto comparison = compare_passes(up, down);
  const PassOffset found = find_shift(up, down, context.seed());
  if (!std::isfinite(found.shift)) {
    return skip(fmt::format(
        "the variance of the differences between the passes ({} beams) has no minimum within {:.3g} deg",
        comparison.beams, kReach * comparison.step / kDegree));
  }
  report(name, found, comparison.step, comparison.beams, context);
  add_findings(name, found, findings);
  const bool generalizes = is_credible(found) && stands_out(found) && found.gain.significant_decrease();
  if (is_credible(found)) {
    data::add_fit_statistics({pass_fit_test(found, generalizes)}, findings);
    context.print(data::fit_statistics_text(findings));
  }
  findings.unobservable.push_back(
      {name + ".tau",
       "both passes measure the same surfaces from the same angles, which does not constrain the mounting",
       ""});
  if (folder_) draw(*folder_, name, comparison, found, context);
  return generalizes && correct_ ? found.shift : 0;
}

void DiagnosePassesStage::finish(Outputs& out, Context& context) {
  if (!plate_ || series_.scans().empty()) throw no_actuated_scans();
  Findings own;
  const double shift = diagnose(own, context);
  findings_.append(own);
  out.give(std::move(findings_));
  out.give(without_offset(*plate_, shift));
  for (const auto& beams : beams_) out.give(beams);
}

}  // namespace crisp::diagnose
