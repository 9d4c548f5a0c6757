// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/stationary_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/rig_echoes.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "plugins/diagnose/scans/scan_prediction_errors.hpp"
#include "plugins/diagnose/scans/stationary_profiles.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::size_t kMinStationary = 24;  // scans
constexpr double kDecisive = 2;             // log10 of the Bayes factor
constexpr double kStands = 3;               // standard errors

/// Whether the shift is accepted: it has the best BIC, exceeds its standard error, and generalizes to
/// held-out scans.
bool is_shift(const ClassOffset& class_offset) {
  return class_offset.log10_bayes_factor > kDecisive &&
         std::abs(class_offset.shift) > kStands * class_offset.shift_error &&
         class_offset.gain.significant_decrease();
}

Gain gain_in_sweep(const ScanSeries& series, const std::vector<double>& shifts, std::size_t period,
                   const Rig& rig, std::uint64_t seed) {
  const auto plate = series.actuator(rig.plate);
  std::vector<double> times, printed, found;
  for (const auto& scan : series.scans()) {
    times.push_back(scan.receipt);
    printed.push_back(scan.scan->start_angle);
    found.push_back(scan.scan->start_angle + shifts[class_of(scan, period)]);
  }
  return prediction_gain(scan_prediction_errors(series.scans(), times, printed, plate),
                         scan_prediction_errors(series.scans(), times, found, plate), seed);
}

Finding finding_of(const std::string& laser, const ClassOffset& class_offset,
                   const ScanInterleave& interleave, double angle_step) {
  Finding finding{.cause = "mirror.interleave", .scope = laser};
  finding.parameters = {{"shift", "rad", class_offset.shift * angle_step,
                         class_offset.shift_error * std::abs(angle_step), true},
                        {"period", "1", static_cast<double>(interleave.period)},
                        {"kind", "1", static_cast<double>(class_offset.kind)}};
  finding.explained_fraction = class_offset.gain.explained();
  finding.log10_bayes_factor = class_offset.log10_bayes_factor;
  finding.p_value = interleave.p_value;
  finding.gain = {class_offset.gain};
  finding.accepted = true;
  return finding;
}

UnnamedFinding unnamed_of(const std::string& laser, const ClassOffset& class_offset,
                          const ScanInterleave& interleave) {
  return {.covariate = fmt::format("count of scans modulo {}", interleave.period),
          .quantity = "range",
          .scope = laser,
          .amplitude = class_offset.gain.before,
          .unit = "m",
          .p_value = interleave.p_value};
}

}  // namespace

void DiagnoseStationaryStage::describe(StageDescription<DiagnoseStationaryStage>& d) {
  d.name("diagnose.stationary")
      .summary("tests stationary scans for systematic differences between scan classes, and corrects them");
  d.details(
      "With a stationary actuator, scans differ by noise alone. If scans at some lag are more alike than consecutive ones, the laser has scan classes that alternate. The stage compares each class's mean profile with that of the class with the most beams. The hypotheses are a shift of the beams' direction, an offset and a scale of the ranges, and no difference. The first half of the stationary scans gives the estimates. The second half validates them, as does the prediction of a sweep's scans from their neighbours.\n\n"
      "A class with shifted beams (`mirror.interleave`) is returned with corrected angles. Other differences are only reported (`unnamed`).");
  d.takes<Scan>()
      .takes<PlateReading>()
      .takes<Findings>(Need::optional)
      .gives<Findings>()
      .gives<Scan>()
      .gives<PlateReading>();
  d.option("correct", &DiagnoseStationaryStage::correct_,
           "whether to correct the angles of the returned scans");
  d.option("folder", &DiagnoseStationaryStage::folder_, "folder for plots of the comparison; auto: no plots")
      .writes_into({"*_rest.svg"});
}

void DiagnoseStationaryStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) findings_.append(*before);
  lasers_.resize(context.rig().lasers.size());
  if (const auto* reading = in.find<PlateReading>()) {
    for (auto& laser : lasers_) laser.series.add(*reading);
    items_.emplace_back(*reading);
  }
  if (auto scan = data::with_used_echoes(in.share<Scan>(), context.rig())) {
    if (scan->echoes.empty() || scan->echoes.front().ranges.empty()) {
      context.count("scans without ranges");
      return;
    }
    const std::size_t laser = scan->laser;
    items_.emplace_back(laser);
    lasers_.at(laser).series.add(std::move(scan));
  }
}

void DiagnoseStationaryStage::report(const std::string& name, const ScanInterleave& interleave,
                                     const std::vector<ClassOffset>& class_offsets, Context& context) {
  std::string lags;
  for (const double d : interleave.difference) lags += fmt::format(" {:.1f}", 1e3 * d);
  context.print(fmt::format(
      "{}: stationary scans at lag 1, 2 … differ by{} mm (permutation test p = {:.3g}): period {}", name,
      lags, interleave.p_value, interleave.period));
  auto kinds = nlohmann::json::array();
  for (const auto& k : class_offsets) {
    context.print(fmt::format(
        "  class {}: beams shifted by {:+.3f} ± {:.3f} beams, ranges then by {:+.1f} ± {:.1f} mm; Bayes factor (BIC) 10^{:.0f} against {}\n"
        "    profile on held-out scans: {:.1f} -> {:.1f} mm (change {:.1f} .. {:.1f}); {:.2f} beams injected, {:.2f} recovered",
        k.kind, k.shift, k.shift_error, 1e3 * k.offset, 1e3 * k.offset_error, k.log10_bayes_factor,
        k.next_likely, 1e3 * k.gain.before, 1e3 * k.gain.after, 1e3 * k.gain.ci95[0], 1e3 * k.gain.ci95[1],
        k.injected, k.recovered));
    kinds.push_back({{"kind", k.kind},
                     {"beams", k.beams},
                     {"shift", k.shift},
                     {"shift_error", k.shift_error},
                     {"offset", k.offset},
                     {"offset_error", k.offset_error},
                     {"put_in", k.injected},
                     {"answer", k.recovered}});
  }
  context.report(
      {{name,
        {{"difference_by_lag", interleave.difference}, {"period", interleave.period}, {"kinds", kinds}}}});
}

void DiagnoseStationaryStage::draw(const std::string& name, const std::vector<ClassOffset>& class_offsets,
                                   Context& context) const {
  if (!folder_ || class_offsets.empty()) return;
  plot::Plot plot{.title = name + ", stationary: difference between scan classes",
                  .x_label = "shift of the class's beams [beams]",
                  .y_label = "RMS difference of the profiles [mm]"};
  for (const auto& class_offset : class_offsets) {
    plot::PlotSeries series{.name = fmt::format("class {}", class_offset.kind), .x = shift_grid()};
    for (const double error : class_offset.error_over_shift) series.y.push_back(1e3 * error);
    plot.series.push_back(std::move(series));
  }
  plot::write_plots(*folder_ / (name + "_rest.svg"), {plot}, context);
}

void DiagnoseStationaryStage::diagnose(std::size_t index, Findings& findings, Context& context) {
  Laser& laser = lasers_[index];
  const std::string& name = context.rig().lasers[index].name;
  const auto still = laser.series.stationary(context.rig().plate);
  if (still.size() < kMinStationary) {
    findings.unobservable.push_back(
        {name + ".mirror.interleave",
         fmt::format("{} stationary scans are too few; at least {} are needed", still.size(), kMinStationary),
         ""});
    return;
  }
  const auto interleave = find_interleave(still, context.seed());
  const auto class_offsets = interleave.period > 1 ? compare_classes(still, interleave.period, context.seed())
                                                   : std::vector<ClassOffset>{};
  report(name, interleave, class_offsets, context);
  draw(name, class_offsets, context);
  laser.period = interleave.period;
  laser.shifts.assign(interleave.period, 0);
  const double step = still.front().scan->angle_step;
  std::vector<Finding> found;
  std::vector<bool> is_moved(interleave.period);
  for (const auto& class_offset : class_offsets) {
    if (is_shift(class_offset)) {
      is_moved[class_offset.kind] = true;
      laser.shifts[class_offset.kind] = class_offset.shift * step;
      found.push_back(finding_of(name, class_offset, interleave, step));
    } else {
      findings.unnamed.push_back(unnamed_of(name, class_offset, interleave));
    }
  }
  if (auto reported = stationary_fit_test(name, still, interleave, is_moved, context.seed())) {
    reported_.push_back(std::move(*reported));
  }
  if (found.empty()) return;
  const Gain sweep = gain_in_sweep(laser.series, laser.shifts, laser.period, context.rig(), context.seed());
  if (std::isfinite(sweep.before)) {
    context.print(fmt::format(
        "  sweep's scans predicted by their neighbours: {:.1f} -> {:.1f} mm (change {:.1f} .. {:.1f})",
        1e3 * sweep.before, 1e3 * sweep.after, 1e3 * sweep.ci95[0], 1e3 * sweep.ci95[1]));
    for (auto& finding : found) finding.gain.push_back(sweep);
  }
  findings.findings.insert(findings.findings.end(), found.begin(), found.end());
}

std::shared_ptr<const Scan> DiagnoseStationaryStage::corrected(const std::shared_ptr<const Scan>& scan) {
  Laser& laser = lasers_[scan->laser];
  const SeriesScan& as_counted = laser.series.scans()[laser.next++];
  const double shift = laser.shifts.empty() ? 0 : laser.shifts[class_of(as_counted, laser.period)];
  if (!correct_ || shift == 0) return scan;
  auto other = std::make_shared<Scan>(*scan);
  other->start_angle += shift;
  return other;
}

void DiagnoseStationaryStage::finish(Outputs& out, Context& context) {
  Findings own;
  for (std::size_t i = 0; i < lasers_.size(); ++i) {
    if (!lasers_[i].series.scans().empty()) diagnose(i, own, context);
    if (context.interrupted()) return;
  }
  data::add_fit_statistics(reported_, own);
  data::add_left_over(reported_, own);
  if (!reported_.empty()) context.print(data::fit_statistics_text(own));
  findings_.append(own);
  out.give(std::move(findings_));
  for (const auto& item : items_) {
    if (const auto* reading = std::get_if<PlateReading>(&item)) {
      out.give(*reading);
    } else {
      const Laser& laser = lasers_[std::get<std::size_t>(item)];
      out.give(corrected(laser.series.scans()[laser.next].scan));
    }
  }
}

}  // namespace crisp::diagnose
