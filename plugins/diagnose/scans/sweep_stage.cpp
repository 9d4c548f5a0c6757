// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/sweep_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/data/rig_echoes.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "plugins/diagnose/scans/bursts.hpp"
#include "plugins/diagnose/scans/range_jump.hpp"
#include "plugins/diagnose/scans/sweep_fit_test.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kSure = 0.01;  // p-value

/// Response of the median prediction error to injected lags.
struct InjectionResponse {
  std::vector<double> by;        ///< [s] injected lag
  std::vector<double> common;    ///< [m] median error with all scans later by the lag
  std::vector<double> by_turns;  ///< [m] with every other scan later by it, and the rest earlier
};

/// One laser's sweep, evaluated for any times of its scans.
class Sweep {
 public:
  Sweep(const ScanSeries& series, PlateTrajectory plate) : series_(series), plate_(std::move(plate)) {
    for (const auto& scan : series.scans()) {
      angles_.push_back(scan.scan->start_angle);
      receipts_.push_back(scan.receipt);
    }
  }
  const std::vector<double>& receipts() const { return receipts_; }
  ScanPredictionErrors errors(const std::vector<double>& times) const {
    return scan_prediction_errors(series_.scans(), times, angles_, plate_);
  }
  /// Goodness of fit for receipt times, and for stamps if they were accepted.
  std::optional<data::GoodnessOfFit> reported(const std::string& laser, const std::vector<double>& stamps,
                                              bool by_stamp, std::uint64_t seed) const {
    std::vector<double> delays = receipts_;
    for (std::size_t i = 0; i < delays.size(); ++i) delays[i] -= stamps[i];
    const auto requested = [&](const std::vector<double>& times) {
      return sweep_fit_test(series_.scans(), scan_scores(series_.scans(), times, angles_, plate_), delays,
                            seed);
    };
    const auto before = requested(receipts_);
    const auto after = by_stamp ? requested(stamps) : before;
    if (!before || !after) return {};
    return data::GoodnessOfFit{.scope = laser, .before = *before, .after = *after};
  }
  InjectionResponse response(const std::vector<double>& times) const {
    constexpr double kStep = 0.004;  // [s]
    constexpr int kSteps = 5;
    InjectionResponse all;
    for (int i = -kSteps; i <= kSteps; ++i) {
      const double by = i * kStep;
      all.by.push_back(by);
      all.common.push_back(errors(moved(times, by, by)).median());
      all.by_turns.push_back(errors(moved(times, by, -by)).median());
    }
    return all;
  }
  static std::vector<double> moved(std::vector<double> times, double even, double odd) {
    for (std::size_t i = 0; i < times.size(); ++i) times[i] += i % 2 == 0 ? even : odd;
    return times;
  }

 private:
  const ScanSeries& series_;
  PlateTrajectory plate_;
  std::vector<double> angles_, receipts_;
};

/// Receipt times alone identify bursts. The gain by stamps needs a sweep.
Finding burst_finding(const std::string& laser, const Bursts& bursts, const std::optional<Gain>& gain) {
  Finding finding{.cause = "latency.bursts", .scope = laser};
  finding.parameters = {{"together", "1", bursts.together, bursts.together_error, true},
                        {"interval", "s", bursts.interval},
                        {"wait", "s", bursts.wait}};
  finding.p_value = bursts.p_value;
  finding.explained_fraction = kNotTested;
  finding.rejection = "without a sweep, the gain of its stamps over receipt times is unknown";
  if (!gain) return finding;
  finding.rejection = {};
  finding.explained_fraction = gain->explained();
  finding.gain = {*gain};
  finding.accepted = gain->significant_decrease();
  return finding;
}

void report_no_sweep(const std::string& laser, Findings& findings, Context& context) {
  const std::string why = "the recording has no sweep of the actuator";
  context.print("  " + why + ", so its stamps cannot be compared with receipt times");
  for (const char* parameter : {".eta", ".tau", ".alpha"}) {
    findings.unobservable.push_back({laser + parameter, why, ""});
  }
}

/// Reports a lag common to all scans as unobservable if the prediction error does not respond to it.
void judge_common_lag(const Sweep& sweep, const std::vector<double>& times, const std::string& laser,
                      std::uint64_t seed, Findings& findings, Context& context) {
  constexpr double kMuch = 0.02;  // [s]
  const auto here = sweep.errors(times);
  std::string text;
  bool seen = true;
  for (const double by : {-kMuch, kMuch}) {
    const Gain change = prediction_gain(here, sweep.errors(Sweep::moved(times, by, by)), seed);
    text += fmt::format("{}{:+.0f} ms changes {:.1f} mm by {:.1f} to {:.1f} mm", text.empty() ? "" : ", ",
                        1e3 * by, 1e3 * change.before, 1e3 * change.ci95[0], 1e3 * change.ci95[1]);
    seen = seen && change.significant_increase();
  }
  context.print("  response to an injected lag common to all scans: " + text);
  if (seen) return;
  findings.unobservable.push_back(
      {laser + ".eta", "predictions from neighbouring scans do not respond to a lag common to all: " + text,
       "lags that differ from scan to scan"});
  for (const char* parameter : {".tau", ".alpha"}) {
    findings.unobservable.push_back(
        {laser + parameter,
         "predictions from neighbouring scans do not depend on it, and a single sweep measures each surface once",
         ""});
  }
}

/// Reports the detection limit of a range step: a single sweep has nothing to compare it with.
void bound_jump(const ScanSeries& series, const std::string& laser, Findings& findings) {
  const auto largest = largest_jump(series.scans());
  if (!largest) return;
  findings.unobservable.push_back(
      {laser + ".range.step",
       fmt::format(
           "ranges change by up to {:.1f} mm between consecutive scans: a smaller step of all ranges is not detectable, and a larger one is not resolvable from the scene",
           1e3 * *largest),
       ""});
}

void draw(const std::filesystem::path& folder, const std::string& laser, const InjectionResponse& response,
          Context& context) {
  const auto scaled = [](std::vector<double> values) {
    for (double& value : values) value *= 1e3;
    return values;
  };
  plot::Plot plot{.title = laser + ": prediction error of scans with injected lags",
                  .x_label = "injected lag [ms]",
                  .y_label = "median error [mm]"};
  plot.series = {{.name = "all scans later", .x = scaled(response.by), .y = scaled(response.common)},
                 {.name = "every other scan later, the rest earlier",
                  .x = scaled(response.by),
                  .y = scaled(response.by_turns)}};
  plot::write_plots(folder / (laser + "_sweep.svg"), {plot}, context);
}

}  // namespace

void DiagnoseSweepStage::describe(StageDescription<DiagnoseSweepStage>& d) {
  d.name("diagnose.sweep").summary("compares receipt times and device stamps of a sweep's scans");
  d.details(
      "The stage predicts each scan of a sweep from the scans before and after it, by the actuator's angles at their times. It compares the prediction errors for receipt times with those for the device's stamps, mapped to the hub's clock by an earlier clock stage. No plane is fitted, no mounting parameter is involved, and the stamps do not depend on ranges, so all scans are held-out data.\n\n"
      "Scans that were taken evenly but arrive in bursts are reported as `latency.bursts`; the clock stage's map then gives their times. The stage injects a lag common to all scans. If the prediction error does not respond to it, the lag is reported as unobservable, as are the offsets of the mounting.");
  d.takes<Scan>().takes<PlateReading>().takes<ClockMap>();
  d.takes<Findings>(Need::optional).gives<Findings>();
  d.option("folder", &DiagnoseSweepStage::folder_,
           "folder for plots of the prediction errors; auto: no plots")
      .writes_into({"*_sweep.svg"});
}

void DiagnoseSweepStage::process(const Inputs& in, Outputs&, Context& context) {
  lasers_.resize(context.rig().lasers.size());
  if (const Findings* before = in.find<Findings>()) findings_.append(*before);
  if (const auto* reading = in.find<PlateReading>()) {
    for (auto& laser : lasers_) laser.add(*reading);
  }
  if (auto scan = data::with_used_echoes(in.share<Scan>(), context.rig())) {
    ScanSeries& laser = lasers_.at(scan->laser);
    laser.add(std::move(scan));
  }
  if (const auto* clock = in.find<ClockMap>()) clocks_.insert_or_assign(clock->device, *clock);
}

void DiagnoseSweepStage::diagnose(std::size_t index, Findings& findings, Context& context) {
  const std::string& name = context.rig().lasers[index].name;
  const auto clock = clocks_.find(name);
  if (clock == clocks_.end()) return;
  const ScanSeries& series = lasers_[index];
  const Sweep sweep(series, series.actuator(context.rig().plate));
  const auto stamps = series.stamped(clock->second);
  const auto bursts = find_bursts(sweep.receipts(), stamps, context.seed());
  const auto by_receipt = sweep.errors(sweep.receipts());
  const auto by_stamp = sweep.errors(stamps);
  const Gain gain = prediction_gain(by_receipt, by_stamp, context.seed());
  context.print(fmt::format(
      "{}: a scan every {:.3f} ms; {:.0f} % arrive in bursts (permutation test p = {:.3g}), up to {:.0f} ms late",
      name, 1e3 * bursts.interval, 100 * bursts.together, bursts.p_value, 1e3 * bursts.longest));
  context.report(
      {{name, {{"interval", bursts.interval}, {"together", bursts.together}, {"longest", bursts.longest}}}});
  const bool found = bursts.p_value < kSure;
  const bool swept = std::isfinite(gain.before);
  if (found)
    findings.findings.push_back(burst_finding(name, bursts, swept ? std::optional(gain) : std::nullopt));
  if (!swept) return report_no_sweep(name, findings, context);
  context.print(fmt::format(
      "  error of scans predicted by their neighbours: by receipt times {:.1f} mm, by stamps {:.1f} mm (change {:.1f} .. {:.1f})",
      1e3 * gain.before, 1e3 * gain.after, 1e3 * gain.ci95[0], 1e3 * gain.ci95[1]));
  if (auto reported = sweep.reported(name, stamps, found && gain.significant_decrease(), context.seed())) {
    reported_.push_back(std::move(*reported));
  }
  judge_common_lag(sweep, stamps, name, context.seed(), findings, context);
  bound_jump(series, name, findings);
  const InjectionResponse response = sweep.response(stamps);
  context.print(fmt::format(
      "  every other scan later by an injected {:.0f} ms, the rest earlier: {:.1f} mm; vice versa {:.1f} mm",
      1e3 * response.by.back(), 1e3 * response.by_turns.back(), 1e3 * response.by_turns.front()));
  context.report({{name + "_answers",
                   {{"by", response.by}, {"common", response.common}, {"by_turns", response.by_turns}}}});
  if (folder_) draw(*folder_, name, response, context);
}

void DiagnoseSweepStage::finish(Outputs& out, Context& context) {
  Findings own;
  for (std::size_t i = 0; i < lasers_.size(); ++i) {
    if (!lasers_[i].scans().empty()) diagnose(i, own, context);
    if (context.interrupted()) return;
  }
  data::add_fit_statistics(reported_, own);
  data::add_left_over(reported_, own);
  if (!reported_.empty()) context.print(data::fit_statistics_text(own));
  findings_.append(own);
  out.give(std::move(findings_));
}

}  // namespace crisp::diagnose
