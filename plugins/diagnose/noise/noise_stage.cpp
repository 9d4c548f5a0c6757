// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/noise_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "pipeline/clocks/unwrap.hpp"
#include "pipeline/data/rig_echoes.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "plugins/diagnose/noise/common_mode_range_error.hpp"
#include "plugins/diagnose/noise/likelihood_gain.hpp"
#include "plugins/diagnose/noise/noise_plots.hpp"
#include "plugins/diagnose/report/findings_report.hpp"

namespace crisp::diagnose {
namespace {

Finding finding_of(const CommonModeChange& change, const std::string& laser) {
  const auto parameter = [](const char* name, const char* unit, double value, double error) {
    return Parameter{.name = name, .unit = unit, .value = value, .std_error = error, .free = true};
  };
  Finding finding{.cause = change.is_step ? "range.step" : "range.warmup",
                  .scope = laser,
                  .parameters = {},
                  .explained_fraction = change.gain.explained(),
                  .log10_bayes_factor = change.log10_bayes_factor,
                  .p_value = change.p_value,
                  .confounded_with = {},
                  .gain = {change.gain},
                  .accepted = change.gain.significant_decrease()};
  // The catalogue's parameters are corrections to be added to a range.
  finding.parameters = {parameter(change.is_step ? "h" : "c", "m", -change.size, change.std_error),
                        parameter(change.is_step ? "at" : "T", "s", change.shape, change.shape_error)};
  return finding;
}

UnnamedFinding finding_of(const CommonModeWander& wander, const std::string& laser) {
  return {.covariate = "time",
          .quantity = "range",
          .scope = laser,
          .amplitude = wander.rms,
          .unit = "m",
          .p_value = wander.p_value,
          .gain = {wander.gain},
          .accepted = wander.gain.significant_decrease()};
}

}  // namespace

void DiagnoseNoiseStage::describe(StageDescription<DiagnoseNoiseStage>& d) {
  d.name("diagnose.noise").summary("estimates the range noise of stationary lasers");
  d.details(
      "Each beam of a stationary laser repeatedly measures the same spot. Beams that meet moving objects (`scene.moving`: ranges far from the beam's median, together with neighbouring beams and scans) are left out. Common-mode errors of all beams are tested scan by scan: a step (`range.step`), a warm-up drift (`range.warmup`), or a slow wander (`unnamed`). The residuals about each beam's mean are compared with the plain simulator's normal noise. Components are noise that grows with range or weak echoes, heavy tails, and two peaks with a weight per beam (`noise.*`). BIC selects them forward, and held-out scans confirm them. A laser is reported as unobservable if its plate turned, its ranges change, it has no echoes, or it sent fewer than 10 scans. A goodness-of-fit test compares the ranges of all lasers with simulated ones, without and with the identified components.");
  d.takes<Scan>().takes<PlateReading>(Need::optional).takes<Findings>(Need::optional).gives<Findings>();
  d.option("folder", &DiagnoseNoiseStage::folder_,
           "folder for plots of each laser's noise and of its common-mode errors; auto: no plots")
      .writes_into({"*_noise.svg"});
}

void DiagnoseNoiseStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) all_.append(*before);
  if (const PlateReading* reading = in.find<PlateReading>()) plate_.add(*reading);
  const auto scan = data::with_used_echoes(in.share<Scan>(), context.rig());
  if (!scan) return;
  if (lasers_.empty()) {
    lasers_.resize(context.rig().lasers.size());
    first_ns_ = scan->receipt_ns;
  }
  if (scan->laser < lasers_.size()) lasers_[scan->laser].add(*scan);
}

void DiagnoseNoiseStage::add_laser(const std::string& name, const StationaryScans& scans, Findings& all,
                                   Context& context) {
  context.count("scans left out of the diagnosis", scans.left_out());
  auto judged = plate_.turned()
                    ? std::variant<RangeErrors, InsufficientData>(InsufficientData{"its plate turned"})
                    : scans.errors();
  const bool is_judged = std::holds_alternative<RangeErrors>(judged);
  const auto moving =
      is_judged ? find_moving_objects(scans.far_shots(), lasers_.size(), context.seed()) : std::nullopt;
  if (moving) {
    all.findings.push_back(finding_of(*moving));
    judged = scans.errors(moving->beams);
  }
  if (const auto* nothing = std::get_if<InsufficientData>(&judged)) {
    context.print(fmt::format("{}: noise not estimated, since {}", name, nothing->why));
    all.unobservable.push_back({name + ".noise.normal", nothing->why, ""});
    return;
  }
  RangeErrors* errors = &std::get<RangeErrors>(judged);
  const RangeErrors measured = *errors;
  const std::int64_t epoch_ns = clocks::epoch_of_run(first_ns_);
  std::vector<double> seconds;
  for (std::size_t scan = 0; scan < scans.scans(); ++scan) {
    seconds.push_back(1e-9 * static_cast<double>(scans.receipt_ns(scan) - epoch_ns));
  }
  std::vector<plot::Plot> plots;
  const CommonModeError together = common_mode_error(*errors, seconds, lasers_.size(), context.seed());
  if (together.change) all.findings.push_back(finding_of(*together.change, name));
  if (together.wander) all.unnamed.push_back(finding_of(*together.wander, name));
  if (together.curve.size() > 0) {
    plots.push_back(common_plot(name, together, *errors, seconds));
    subtract_curve(together.curve, *errors);
  }
  const NoiseDiagnosis noise = diagnose_noise(name, *errors, context.seed());
  context.print(fmt::format("{}: {} ranges of stationary beams have noise of {:.2f} mm (RMS)", name,
                            errors->size(), 1e3 * noise.plain.sigma()));
  all.noise.push_back({.laser = name, .ranges = errors->size(), .sigma = noise.model.sigma()});
  all.findings.insert(all.findings.end(), noise.findings.begin(), noise.findings.end());
  all.unnamed.insert(all.unnamed.end(), noise.unnamed.begin(), noise.unnamed.end());
  const bool changes = together.change && together.change->gain.significant_decrease();
  reported_.push_back(goodness_of_fit(name, measured, noise.model,
                                      changes ? together.named : Eigen::VectorXd(), BeamsOf::kLaserAtRest,
                                      context.seed()));
  share_explained(std::span(all.findings).last(noise.findings.size()),
                  std::span(all.unnamed).last(noise.unnamed.size()));
  constexpr double kMayDepart = 0.01;  // above this p-value, there is no deviation to explain
  if (reported_.back().after.p_value < kMayDepart) {
    const auto left =
        goodness_of_noise_model(measured, noise.model, together.curve, BeamsOf::kLaserAtRest, context.seed());
    data::add_left_over(name, left, lasers_.size(), all);
  }
  std::ranges::move(noise_plots(name, *errors, noise), std::back_inserter(plots));
  if (folder_) plot::write_plots(*folder_ / (name + "_noise.svg"), plots, context);
}

void DiagnoseNoiseStage::finish(Outputs& out, Context& context) {
  Findings all;
  for (std::size_t laser = 0; laser < lasers_.size(); ++laser) {
    if (lasers_[laser].scans() == 0) continue;
    context.progress(static_cast<double>(laser) / static_cast<double>(lasers_.size()), "fitting noise");
    if (context.interrupted()) return;
    add_laser(context.rig().lasers[laser].name, lasers_[laser], all, context);
  }
  data::add_fit_statistics(reported_, all);
  for (const Finding& finding : all.findings) context.print(in_words(finding));
  for (const UnnamedFinding& finding : all.unnamed) context.print(in_words(finding));
  if (!reported_.empty()) context.print(data::fit_statistics_text(all));
  context.report({{"findings", all.findings.size()}, {"before_p", all.before_p}, {"after_p", all.after_p}});
  all_.append(all);
  out.give(std::move(all_));
}

}  // namespace crisp::diagnose
