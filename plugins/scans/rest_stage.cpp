// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/rest_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/data/degree.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "plugins/scans/neighbours.hpp"
#include "plugins/scans/profiles_at_rest.hpp"

namespace crisp {
namespace {

constexpr std::size_t kFewestAtRest = 24;  // scans
constexpr double kSureOdds = 2;            // log10
constexpr double kStands = 3;              // standard errors

/// A shift that is likelier than all else, stands out of its error, and paid on scans that it was not found
/// in.
bool is_shift(const KindDeparture& departure) {
  return departure.log10_odds > kSureOdds && std::abs(departure.shift) > kStands * departure.shift_error &&
         departure.gain.surely_falls();
}

Gain gain_in_sweep(const ScanSeries& series, const std::vector<double>& shifts, std::size_t period,
                   const Rig& rig, std::uint64_t seed) {
  const auto plate = series.actuator(rig.plate);
  std::vector<double> times, said, found;
  for (const auto& scan : series.scans()) {
    times.push_back(scan.receipt);
    said.push_back(scan.scan->start_angle);
    found.push_back(scan.scan->start_angle + shifts[kind_of(scan, period)]);
  }
  return neighbour_gain(neighbour_errors(series.scans(), times, said, plate),
                        neighbour_errors(series.scans(), times, found, plate), seed);
}

Finding finding_of(const std::string& laser, const KindDeparture& departure, const Alternation& alternation,
                   double angle_step) {
  Finding finding{.cause = "mirror.interleave", .scope = laser};
  finding.parameters = {
      {"shift", "rad", departure.shift * angle_step, departure.shift_error * std::abs(angle_step), true},
      {"period", "1", static_cast<double>(alternation.period)},
      {"kind", "1", static_cast<double>(departure.kind)}};
  finding.explained_fraction = departure.gain.explained();
  finding.log10_odds = departure.log10_odds;
  finding.p_value = alternation.p_value;
  finding.gain = {departure.gain};
  finding.accepted = true;
  return finding;
}

UnnamedFinding unnamed_of(const std::string& laser, const KindDeparture& departure,
                          const Alternation& alternation) {
  return {.covariate = fmt::format("count of scans modulo {}", alternation.period),
          .quantity = "range",
          .scope = laser,
          .amplitude = departure.gain.before,
          .unit = "m",
          .p_value = alternation.p_value};
}

}  // namespace

void DiagnoseRestStage::describe(StageDescription<DiagnoseRestStage>& d) {
  d.name("diagnose.rest")
      .summary("asks of scans at rest whether they are all alike, and mends those that are not");
  d.details(
      "Where the actuator stands still, scans differ by noise alone. If those some scans apart are more "
      "alike than "
      "those next to one another, the laser has kinds of scans that take turns. Each kind's mean profile is "
      "then "
      "compared with that of the kind with most beams: the direction in which its beams point, an offset and "
      "a scale "
      "of its ranges stand against each other, and against nothing. Found in the first half of the scans at "
      "rest, "
      "judged by the second half, and by how well scans of a sweep are foretold by their neighbours.\n\n"
      "A kind whose beams point elsewhere (`mirror.interleave`) is given on with its true angles; of what is "
      "otherwise different it only says that it is (`unnamed`).");
  d.takes<Scan>()
      .takes<PlateReading>()
      .takes<Findings>(Need::optional)
      .gives<Findings>()
      .gives<Scan>()
      .gives<PlateReading>();
  d.option("mend", &DiagnoseRestStage::mend_,
           "whether the scans that it gives have the angles that were found");
  d.option("folder", &DiagnoseRestStage::folder_, "where plots go; auto: nowhere")
      .writes_into({"*_rest.svg"});
}

void DiagnoseRestStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) findings_.append(*before);
  lasers_.resize(context.rig().lasers.size());
  if (const auto* reading = in.find<PlateReading>()) {
    for (auto& laser : lasers_) laser.series.add(*reading);
    items_.emplace_back(*reading);
  }
  if (auto scan = in.share<Scan>()) {
    if (scan->echoes.empty() || scan->echoes.front().ranges.empty()) {
      context.count("scans without ranges");
      return;
    }
    const std::size_t laser = scan->laser;
    items_.emplace_back(laser);
    lasers_.at(laser).series.add(std::move(scan));
  }
}

void DiagnoseRestStage::report(const std::string& name, const Alternation& alternation,
                               const std::vector<KindDeparture>& departures, Context& context) {
  std::string lags;
  for (const double d : alternation.difference) lags += fmt::format(" {:.1f}", 1e3 * d);
  context.say(fmt::format(
      "{}: scans 1, 2 … apart differ at rest by{} mm (p {:.3g} in random order): they repeat every {}", name,
      lags, alternation.p_value, alternation.period));
  auto kinds = nlohmann::json::array();
  for (const auto& k : departures) {
    context.say(
        fmt::format("  kind {}: its beams point {:+.3f} ± {:.3f} beams further, ranges then off by {:+.1f} ± "
                    "{:.1f} mm; odds "
                    "10^{:.0f} against {}\n"
                    "    profile on other scans: {:.1f} -> {:.1f} mm (change {:.1f} .. {:.1f}); {:.2f} beams "
                    "put in by hand: {:.2f}",
                    k.kind, k.shift, k.shift_error, 1e3 * k.offset, 1e3 * k.offset_error, k.log10_odds,
                    k.next_likely, 1e3 * k.gain.before, 1e3 * k.gain.after, 1e3 * k.gain.ci95[0],
                    1e3 * k.gain.ci95[1], k.put_in, k.answer));
    kinds.push_back({{"kind", k.kind},
                     {"beams", k.beams},
                     {"shift", k.shift},
                     {"shift_error", k.shift_error},
                     {"offset", k.offset},
                     {"offset_error", k.offset_error},
                     {"put_in", k.put_in},
                     {"answer", k.answer}});
  }
  context.report(
      {{name,
        {{"difference_by_lag", alternation.difference}, {"period", alternation.period}, {"kinds", kinds}}}});
}

void DiagnoseRestStage::draw(const std::string& name, const std::vector<KindDeparture>& departures,
                             Context& context) const {
  if (!folder_ || departures.empty()) return;
  Plot plot{.title = name + " at rest: one kind of scan against the other",
            .x_label = "shift of its beams [beams]",
            .y_label = "RMS difference of the profiles [mm]"};
  for (const auto& departure : departures) {
    PlotSeries series{.name = fmt::format("kind {}", departure.kind), .x = shift_grid()};
    for (const double error : departure.error_over_shift) series.y.push_back(1e3 * error);
    plot.series.push_back(std::move(series));
  }
  write_plots(*folder_ / (name + "_rest.svg"), {plot}, context);
}

void DiagnoseRestStage::diagnose(std::size_t index, Findings& findings, Context& context) {
  Laser& laser = lasers_[index];
  const std::string& name = context.rig().lasers[index].name;
  const auto still = laser.series.at_rest(context.rig().plate);
  if (still.size() < kFewestAtRest) {
    findings.unobservable.push_back(
        {name + ".mirror.interleave",
         fmt::format("{} scans were taken at rest; {} are needed", still.size(), kFewestAtRest), ""});
    return;
  }
  const auto alternation = find_alternation(still, context.seed());
  const auto departures = alternation.period > 1 ? compare_kinds(still, alternation.period, context.seed())
                                                 : std::vector<KindDeparture>{};
  report(name, alternation, departures, context);
  draw(name, departures, context);
  laser.period = alternation.period;
  laser.shifts.assign(alternation.period, 0);
  const double step = still.front().scan->angle_step;
  std::vector<Finding> found;
  std::vector<bool> is_moved(alternation.period);
  for (const auto& departure : departures) {
    if (is_shift(departure)) {
      is_moved[departure.kind] = true;
      laser.shifts[departure.kind] = departure.shift * step;
      found.push_back(finding_of(name, departure, alternation, step));
    } else {
      findings.unnamed.push_back(unnamed_of(name, departure, alternation));
    }
  }
  if (auto told = told_at_rest(name, still, alternation, is_moved, context.seed())) {
    told_.push_back(std::move(*told));
  }
  if (found.empty()) return;
  const Gain sweep = gain_in_sweep(laser.series, laser.shifts, laser.period, context.rig(), context.seed());
  if (std::isfinite(sweep.before)) {
    context.say(fmt::format(
        "  scans of the sweep foretold by their neighbours: {:.1f} -> {:.1f} mm (change {:.1f} .. {:.1f})",
        1e3 * sweep.before, 1e3 * sweep.after, 1e3 * sweep.ci95[0], 1e3 * sweep.ci95[1]));
    for (auto& finding : found) finding.gain.push_back(sweep);
  }
  findings.findings.insert(findings.findings.end(), found.begin(), found.end());
}

std::shared_ptr<const Scan> DiagnoseRestStage::mended(const std::shared_ptr<const Scan>& scan) {
  Laser& laser = lasers_[scan->laser];
  const SeriesScan& as_counted = laser.series.scans()[laser.next++];
  const double shift = laser.shifts.empty() ? 0 : laser.shifts[kind_of(as_counted, laser.period)];
  if (!mend_ || shift == 0) return scan;
  auto other = std::make_shared<Scan>(*scan);
  other->start_angle += shift;
  return other;
}

void DiagnoseRestStage::finish(Outputs& out, Context& context) {
  Findings own;
  for (std::size_t i = 0; i < lasers_.size(); ++i) {
    if (!lasers_[i].series.scans().empty()) diagnose(i, own, context);
    if (context.interrupted()) return;
  }
  add_likeness(told_, own);
  add_left_over(told_, own);
  if (!told_.empty()) context.say(likeness_in_words(own));
  findings_.append(own);
  out.give(std::move(findings_));
  for (const auto& item : items_) {
    if (const auto* reading = std::get_if<PlateReading>(&item)) {
      out.give(*reading);
    } else {
      const Laser& laser = lasers_[std::get<std::size_t>(item)];
      out.give(mended(laser.series.scans()[laser.next].scan));
    }
  }
}

}  // namespace crisp
