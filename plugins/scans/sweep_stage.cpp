// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/sweep_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/plot/write_plot.hpp"
#include "plugins/scans/bursts.hpp"
#include "plugins/scans/range_jump.hpp"
#include "plugins/scans/told_in_sweep.hpp"

namespace crisp {
namespace {

constexpr double kSure = 0.01;  // p

/// What the measure makes of scans that are timed otherwise by hand.
struct Answers {
  std::vector<double> by;        ///< [s]
  std::vector<double> common;    ///< [m] median error with all scans later by that
  std::vector<double> by_turns;  ///< [m] with every other scan later, and the rest earlier
};

/// One laser's series, its angles and the actuator, and what the measure says of any times.
class Sweep {
 public:
  Sweep(const ScanSeries& series, PlateTrajectory plate) : series_(series), plate_(std::move(plate)) {
    for (const auto& scan : series.scans()) {
      angles_.push_back(scan.scan->start_angle);
      receipts_.push_back(scan.receipt);
    }
  }
  const std::vector<double>& receipts() const { return receipts_; }
  NeighbourErrors errors(const std::vector<double>& times) const {
    return neighbour_errors(series_.scans(), times, angles_, plate_);
  }
  /// Of times by receipt, and then by stamp if that is what was found.
  std::optional<ToldApart> told(const std::string& laser, const std::vector<double>& stamps, bool by_stamp,
                                std::uint64_t seed) const {
    std::vector<double> delays = receipts_;
    for (std::size_t i = 0; i < delays.size(); ++i) delays[i] -= stamps[i];
    const auto asked = [&](const std::vector<double>& times) {
      return told_in_sweep(series_.scans(), scan_pulls(series_.scans(), times, angles_, plate_), delays,
                           seed);
    };
    const auto before = asked(receipts_);
    const auto after = by_stamp ? asked(stamps) : before;
    if (!before || !after) return {};
    return ToldApart{.scope = laser, .before = *before, .after = *after};
  }
  Answers answers(const std::vector<double>& times) const {
    constexpr double kStep = 0.004;  // [s]
    constexpr int kSteps = 5;
    Answers all;
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

/// Bursts are told by times alone. What their stamps bring is told by a sweep, where there is one.
Finding burst_finding(const std::string& laser, const Bursts& bursts, const std::optional<Gain>& gain) {
  Finding finding{.cause = "latency.bursts", .scope = laser};
  finding.parameters = {{"together", "1", bursts.together, bursts.together_error, true},
                        {"interval", "s", bursts.interval},
                        {"wait", "s", bursts.wait}};
  finding.p_value = bursts.p_value;
  finding.explained_fraction = kUnasked;
  finding.refused = "no sweep says whether its stamps time its scans better";
  if (!gain) return finding;
  finding.refused = {};
  finding.explained_fraction = gain->explained();
  finding.gain = {*gain};
  finding.accepted = gain->surely_falls();
  return finding;
}

void tell_no_sweep(const std::string& laser, Findings& findings, Context& context) {
  const std::string why = "no sweep of the actuator was seen";
  context.say("  " + why + ": whether its stamps time its scans rightly is not told");
  for (const char* parameter : {".eta", ".tau", ".alpha"}) {
    findings.unobservable.push_back({laser + parameter, why, ""});
  }
}

/// A lag common to all scans, if the measure cannot see it.
void judge_common_lag(const Sweep& sweep, const std::vector<double>& times, const std::string& laser,
                      std::uint64_t seed, Findings& findings, Context& context) {
  constexpr double kMuch = 0.02;  // [s]
  const auto here = sweep.errors(times);
  std::string text;
  bool seen = true;
  for (const double by : {-kMuch, kMuch}) {
    const Gain change = neighbour_gain(here, sweep.errors(Sweep::moved(times, by, by)), seed);
    text += fmt::format("{}{:+.0f} ms changes {:.1f} mm by {:.1f} .. {:.1f} mm", text.empty() ? "" : ", ",
                        1e3 * by, 1e3 * change.before, 1e3 * change.ci95[0], 1e3 * change.ci95[1]);
    seen = seen && change.surely_rises();
  }
  context.say("  a lag put in by hand that is common to all scans: " + text);
  if (seen) return;
  findings.unobservable.push_back(
      {laser + ".eta", "scans foretold by their neighbours do not answer to a lag common to all: " + text,
       "only lags that differ from scan to scan are seen"});
  for (const char* parameter : {".tau", ".alpha"}) {
    findings.unobservable.push_back(
        {laser + parameter, "the measure does not hold it, and in a single sweep each surface is seen once",
         ""});
  }
}

/// How large a jump of all ranges would have to be: there is nothing beside a single sweep to tell it by.
void bound_jump(const ScanSeries& series, const std::string& laser, Findings& findings) {
  const auto largest = largest_jump(series.scans());
  if (!largest) return;
  findings.unobservable.push_back(
      {laser + ".range.step",
       fmt::format(
           "from one scan to the next ranges change together by up to {:.1f} mm: a jump of all that is no "
           "larger does not show, and one that is may as well be the scene's",
           1e3 * *largest),
       ""});
}

void draw(const std::filesystem::path& folder, const std::string& laser, const Answers& answers,
          Context& context) {
  const auto scaled = [](std::vector<double> values) {
    for (double& value : values) value *= 1e3;
    return values;
  };
  Plot plot{.title = laser + ": scans foretold by their neighbours, timed otherwise by hand",
            .x_label = "by how much [ms]",
            .y_label = "median error [mm]"};
  plot.series = {{.name = "all scans later", .x = scaled(answers.by), .y = scaled(answers.common)},
                 {.name = "every other scan later, the rest earlier",
                  .x = scaled(answers.by),
                  .y = scaled(answers.by_turns)}};
  write_plots(folder / (laser + "_sweep.svg"), {plot}, context);
}

}  // namespace

void DiagnoseSweepStage::describe(StageDescription<DiagnoseSweepStage>& d) {
  d.name("diagnose.sweep").summary("asks whether scans of a sweep are timed rightly by their receipt");
  d.details(
      "Each scan of a sweep is foretold from the one before and the one after, by the actuator's angles at "
      "the times "
      "of the three. Times of receipt stand against the device's own stamps, as a clock stage above maps "
      "them to the "
      "hub's clock. No plane is fitted, no parameter of the mounting enters, and the stamps have seen no "
      "range: all "
      "scans are held out.\n\n"
      "Scans that come in bursts though they were taken evenly are `latency.bursts`; the clock stage's map "
      "is then the "
      "model of their times. A lag common to all scans is put in by hand, and where the measure does not "
      "answer, it is "
      "called unobservable, as are the mounting's offsets.");
  d.takes<Scan>().takes<PlateReading>().takes<ClockMap>();
  d.takes<Findings>(Need::optional).gives<Findings>();
  d.option("folder", &DiagnoseSweepStage::folder_, "where plots go; auto: nowhere")
      .writes_into({"*_sweep.svg"});
}

void DiagnoseSweepStage::process(const Inputs& in, Outputs&, Context& context) {
  lasers_.resize(context.rig().lasers.size());
  if (const Findings* before = in.find<Findings>()) findings_.append(*before);
  if (const auto* reading = in.find<PlateReading>()) {
    for (auto& laser : lasers_) laser.add(*reading);
  }
  if (auto scan = in.share<Scan>()) {
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
  const Gain gain = neighbour_gain(by_receipt, by_stamp, context.seed());
  context.say(
      fmt::format("{}: a scan every {:.3f} ms; {:.0f} % come together with the one before (p {:.3g}), up to "
                  "{:.0f} ms late",
                  name, 1e3 * bursts.interval, 100 * bursts.together, bursts.p_value, 1e3 * bursts.longest));
  context.report(
      {{name, {{"interval", bursts.interval}, {"together", bursts.together}, {"longest", bursts.longest}}}});
  const bool found = bursts.p_value < kSure;
  const bool swept = std::isfinite(gain.before);
  if (found)
    findings.findings.push_back(burst_finding(name, bursts, swept ? std::optional(gain) : std::nullopt));
  if (!swept) return tell_no_sweep(name, findings, context);
  context.say(
      fmt::format("  foretold by their neighbours, timed by receipt {:.1f} mm, by stamp {:.1f} mm (change "
                  "{:.1f} .. {:.1f})",
                  1e3 * gain.before, 1e3 * gain.after, 1e3 * gain.ci95[0], 1e3 * gain.ci95[1]));
  if (auto told = sweep.told(name, stamps, found && gain.surely_falls(), context.seed())) {
    told_.push_back(std::move(*told));
  }
  judge_common_lag(sweep, stamps, name, context.seed(), findings, context);
  bound_jump(series, name, findings);
  const Answers answers = sweep.answers(stamps);
  context.say(
      fmt::format("  every other scan put {:.0f} ms later by hand, and the rest earlier: {:.1f} mm; the "
                  "other way about {:.1f} mm",
                  1e3 * answers.by.back(), 1e3 * answers.by_turns.back(), 1e3 * answers.by_turns.front()));
  context.report({{name + "_answers",
                   {{"by", answers.by}, {"common", answers.common}, {"by_turns", answers.by_turns}}}});
  if (folder_) draw(*folder_, name, answers, context);
}

void DiagnoseSweepStage::finish(Outputs& out, Context& context) {
  Findings own;
  for (std::size_t i = 0; i < lasers_.size(); ++i) {
    if (!lasers_[i].scans().empty()) diagnose(i, own, context);
    if (context.interrupted()) return;
  }
  add_likeness(told_, own);
  add_left_over(told_, own);
  if (!told_.empty()) context.say(likeness_in_words(own));
  findings_.append(own);
  out.give(std::move(findings_));
}

}  // namespace crisp
