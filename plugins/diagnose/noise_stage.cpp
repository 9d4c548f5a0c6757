// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "pipeline/clocks/unwrap.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "plugins/diagnose/common_change.hpp"
#include "plugins/diagnose/likelihood_gain.hpp"
#include "plugins/diagnose/noise_plots.hpp"
#include "plugins/diagnose/report.hpp"

namespace crisp {
namespace {

Finding finding_of(const CommonChange& change, const std::string& laser) {
  const auto parameter = [](const char* name, const char* unit, double value, double error) {
    return Parameter{.name = name, .unit = unit, .value = value, .std_error = error, .free = true};
  };
  Finding finding{.cause = change.is_step ? "range.step" : "range.warmup",
                  .scope = laser,
                  .parameters = {},
                  .explained_fraction = change.gain.explained(),
                  .log10_odds = change.log10_odds,
                  .p_value = change.p_value,
                  .confounded_with = {},
                  .gain = {change.gain},
                  .accepted = change.gain.surely_falls()};
  // The catalogue has what is to be added to a range.
  finding.parameters = {parameter(change.is_step ? "h" : "c", "m", -change.size, change.std_error),
                        parameter(change.is_step ? "at" : "T", "s", change.shape, change.shape_error)};
  return finding;
}

UnnamedFinding finding_of(const CommonWander& wander, const std::string& laser) {
  return {.covariate = "time",
          .quantity = "range",
          .scope = laser,
          .amplitude = wander.rms,
          .unit = "m",
          .p_value = wander.p_value,
          .gain = {wander.gain},
          .accepted = wander.gain.surely_falls()};
}

}  // namespace

void DiagnoseNoiseStage::describe(StageDescription<DiagnoseNoiseStage>& d) {
  d.name("diagnose.noise").summary("says how the ranges of lasers that stand still scatter");
  d.details(
      "Each beam of a laser at rest meets the same spot again and again. Beams before which something moves "
      "(`scene.moving`: their ranges leave where they usually end by far more than they scatter, together "
      "with their neighbours, scan after scan) are left out. What all beams do together (a jump, "
      "`range.step`, a creeping, `range.warmup`, or a slow wander, `unnamed`) is looked for scan by scan. "
      "What is left of each beam about its mean is compared with the normal law of the plain simulator: a "
      "spread that grows with the range or with weak echoes, heavy tails, two peaks with a weight of each "
      "beam's own (`noise.*`), forward by BIC, each judged by scans that it was not fitted to. Of a laser "
      "that "
      "moves (its plate turns, or its ranges change), has no echoes or sent fewer than 10 scans it is said "
      "that "
      "nothing can be said. Whether its ranges can still be told from simulated ones, without and with what "
      "was found, is said of all lasers together.");
  d.takes<Scan>().takes<PlateReading>(Need::optional).takes<Findings>(Need::optional).gives<Findings>();
  d.option("folder", &DiagnoseNoiseStage::folder_,
           "where plots of each laser's noise go, and of what its ranges did at once; auto: nowhere")
      .writes_into({"*_noise.svg"});
}

void DiagnoseNoiseStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) all_.append(*before);
  if (const PlateReading* reading = in.find<PlateReading>()) plate_.add(*reading);
  const Scan* scan = in.find<Scan>();
  if (!scan) return;
  if (lasers_.empty()) {
    lasers_.resize(context.rig().lasers.size());
    first_ns_ = scan->receipt_ns;
  }
  if (scan->laser < lasers_.size()) lasers_[scan->laser].add(*scan);
}

void DiagnoseNoiseStage::add_laser(const std::string& name, const AtRest& scans, Findings& all,
                                   Context& context) {
  context.count("scans left out of the diagnosis", scans.left_out());
  auto judged = plate_.turned()
                    ? std::variant<RangeErrors, NothingSaid>(NothingSaid{"the plate that it sits on turned"})
                    : scans.errors();
  const bool is_judged = std::holds_alternative<RangeErrors>(judged);
  const auto moving = is_judged ? moved(scans.far_shots(), lasers_.size(), context.seed()) : std::nullopt;
  if (moving) {
    all.findings.push_back(finding_of(*moving));
    judged = scans.errors(moving->beams);
  }
  if (const auto* nothing = std::get_if<NothingSaid>(&judged)) {
    context.say(fmt::format("nothing is said of the noise of {}: {}", name, nothing->why));
    all.unobservable.push_back({name + ".noise.normal", nothing->why, ""});
    return;
  }
  RangeErrors* errors = &std::get<RangeErrors>(judged);
  const RangeErrors measured = *errors;
  const std::int64_t epoch_ns = epoch_of_run(first_ns_);
  std::vector<double> seconds;
  for (std::size_t scan = 0; scan < scans.scans(); ++scan) {
    seconds.push_back(1e-9 * static_cast<double>(scans.receipt_ns(scan) - epoch_ns));
  }
  std::vector<Plot> plots;
  const DoneTogether together = done_together(*errors, seconds, lasers_.size(), context.seed());
  if (together.change) all.findings.push_back(finding_of(*together.change, name));
  if (together.wander) all.unnamed.push_back(finding_of(*together.wander, name));
  if (together.curve.size() > 0) {
    plots.push_back(common_plot(name, together, *errors, seconds));
    take_out(together.curve, *errors);
  }
  const NoiseDiagnosis noise = diagnose_noise(name, *errors, context.seed());
  context.say(fmt::format("{}: {} ranges of beams at rest scatter by {:.2f} mm (RMS)", name, errors->size(),
                          1e3 * noise.plain.sigma()));
  all.noise.push_back({.laser = name, .ranges = errors->size(), .sigma = noise.law.sigma()});
  all.findings.insert(all.findings.end(), noise.findings.begin(), noise.findings.end());
  all.unnamed.insert(all.unnamed.end(), noise.unnamed.begin(), noise.unnamed.end());
  const bool changes = together.change && together.change->gain.surely_falls();
  told_.push_back(told_apart(name, measured, noise.law, changes ? together.named : Eigen::VectorXd(),
                             BeamsOf::kLaserAtRest, context.seed()));
  share_explained(std::span(all.findings).last(noise.findings.size()),
                  std::span(all.unnamed).last(noise.unnamed.size()));
  constexpr double kMayDepart = 0.01;  // else nothing is left to be looked for
  if (told_.back().after.p_value < kMayDepart) {
    const auto left = beside_law(measured, noise.law, together.curve, BeamsOf::kLaserAtRest, context.seed());
    add_left_over(name, left, lasers_.size(), all);
  }
  std::ranges::move(noise_plots(name, *errors, noise), std::back_inserter(plots));
  if (folder_) write_plots(*folder_ / (name + "_noise.svg"), plots, context);
}

void DiagnoseNoiseStage::finish(Outputs& out, Context& context) {
  Findings all;
  for (std::size_t laser = 0; laser < lasers_.size(); ++laser) {
    if (lasers_[laser].scans() == 0) continue;
    context.progress(static_cast<double>(laser) / static_cast<double>(lasers_.size()), "fitting noise");
    if (context.interrupted()) return;
    add_laser(context.rig().lasers[laser].name, lasers_[laser], all, context);
  }
  add_likeness(told_, all);
  for (const Finding& finding : all.findings) context.say(in_words(finding));
  for (const UnnamedFinding& finding : all.unnamed) context.say(in_words(finding));
  if (!told_.empty()) context.say(likeness_in_words(all));
  context.report({{"findings", all.findings.size()}, {"before_p", all.before_p}, {"after_p", all.after_p}});
  all_.append(all);
  out.give(std::move(all_));
}

}  // namespace crisp
