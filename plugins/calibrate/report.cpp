// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "pipeline/data/recordings.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/identifiability.hpp"
#include "plugins/calibrate/cloud_objective.hpp"
#include "plugins/calibrate/correlations.hpp"
#include "plugins/calibrate/rig_check.hpp"

namespace crisp::calibrate {
namespace {

nlohmann::json json_of(const Parameter& p) {
  return {{"value", p.value}, {"unit", p.unit}, {"std_error", p.std_error}, {"free", p.free}};
}

std::string in_words(const Unobservable& u) {
  return fmt::format("{} is not observable: {}{}{}", u.parameter, u.reason,
                     u.combination.empty() ? "" : "; known is ", u.combination);
}

void report_correlations(const Calibration& calibration, Context& context) {
  constexpr std::size_t kMax = 3;
  constexpr double kMin = 0.7;
  auto section = nlohmann::json::array();
  std::vector<std::string> words;
  for (const Correlation& pair : strongest_correlations(calibration, kMax, kMin)) {
    section.push_back({{"one", pair.one}, {"other", pair.other}, {"value", pair.value}});
    words.push_back(fmt::format("{} and {}: {:+.2f}", pair.one, pair.other, pair.value));
  }
  context.report({{"correlations", section}});
  if (!words.empty()) context.print(fmt::format("strongest correlations: {}", fmt::join(words, ", ")));
}

void report_rqe(const std::map<std::string, double>& quality, Context& context) {
  if (!quality.contains("rqe_before") || !quality.contains("rqe_after")) return;
  const auto start = quality.find("rqe_unrefined");
  context.print(fmt::format("RQE {:.4f} before{}, {:.4f} after (sigma {:g} cm)", quality.at("rqe_before"),
                            start != quality.end() ? fmt::format(", {:.4f} unrefined", start->second) : "",
                            quality.at("rqe_after"), quality.at("rqe_sigma") * 100));
}

}  // namespace

std::vector<double> rqe_of(const std::vector<SensorModel>& models, const estimate::Sample& sample,
                           const CrispnessSettings& settings, Measure& measure) {
  estimate::LagRange lags = estimate::lag_range(models.front(), 0);
  for (const SensorModel& model : models) {
    const estimate::LagRange own = estimate::lag_range(model, 0);
    lags = {.earliest = std::min(lags.earliest, own.earliest), .latest = std::max(lags.latest, own.latest)};
  }
  estimate::Sample beams = estimate::covered(sample, lags.earliest, lags.latest);
  for (const SensorModel& model : models) beams = estimate::placeable(model, beams);
  beams = estimate::thin_by_area(beams, models.front(), settings.points, 1);
  std::vector<double> all;
  for (const SensorModel& model : models) all.push_back(model_quality(model, beams, measure, settings.sigma));
  return all;
}

void report(const Calibration& calibration, const Calibration& start, Context& context) {
  context.print(estimate::table_of(calibration, context.rig()));
  nlohmann::json lasers;
  for (const auto& laser : calibration.lasers) {
    for (const auto* p : {&laser.lambda, &laser.tau, &laser.alpha, &laser.eta}) {
      lasers[laser.name][p->name] = json_of(*p);
    }
  }
  nlohmann::json unobservable = nlohmann::json::array();
  bool is_steady = false;
  for (const auto& u : calibration.unobservable) {
    unobservable.push_back(
        {{"parameter", u.parameter}, {"reason", u.reason}, {"combination", u.combination}});
    const bool reported_before = std::any_of(start.unobservable.begin(), start.unobservable.end(),
                                             [&](const auto& old) { return old.parameter == u.parameter; });
    if (reported_before) continue;
    context.warn(in_words(u));
    is_steady = is_steady || (u.parameter.ends_with(".eta") && u.reason == estimate::kNotByMotion);
  }
  if (is_steady) {
    context.warn(
        "the plate's rate hardly changes, which determines lambda and eta together only: the cloud is right at this rate, and the calibration is wrong for recordings at another. Record with a changing rate (0.5 to 2 Hz) to determine both");
  }
  context.report({{"lasers", lasers}, {"quality", calibration.quality}, {"unobservable", unobservable}});
  report_correlations(calibration, context);
  report_rqe(calibration.quality, context);
}

void report_direction(const Calibration& calibration, const Calibration& start, Context& context) {
  const auto source_of = [](const Calibration& one) {
    const auto found = one.provenance.find(kDirectionSource);
    return found == one.provenance.end() ? std::string() : found->second;
  };
  const std::string direction =
      calibration.direction == CountDirection::clockwise ? "clockwise" : "counter_clockwise";
  const std::string source = source_of(calibration);
  context.report({{kDirectionSource, source}});
  if (source == source_of(start)) return;
  if (source == kFromRig) {
    context.warn(fmt::format(
        "plate.direction: {} is known from the rig only, since the mirror image agrees with the nominal values as well. If it is wrong, the cloud is the mirror image of the scene: compare both once, or find the direction by hand",
        direction));
  } else if (source_of(start) == kFromRig) {
    context.print(
        "plate.direction: the refined values contradict the mirror image, so that the recording confirms it");
  }
}

void report(const std::optional<estimate::CrossValidation>& halves, Context& context) {
  if (!halves) {
    context.print(
        "no cross-validation, which needs two turns of the plate, and that half of the turns determines what all do");
    return;
  }
  context.report(
      {{"cross_validation",
        {{"difference", halves->difference}, {"expected", halves->expected}, {"ratio", halves->ratio()}}}});
  context.print(fmt::format(
      "cross-validation: fitted to either half of the turns, the clouds differ by {:.2f} mm (RMS), {:.2g} times their standard errors (1 or less is good)",
      halves->difference * 1e3, halves->ratio()));
}

void report(const std::vector<estimate::ViewConsistency>& views, Context& context) {
  auto section = nlohmann::json::array();
  for (const auto& pair : views) {
    section.push_back({{"view", pair.view},
                       {"other", pair.other},
                       {"on", in_words(pair.orientation)},
                       {"beams", pair.beams},
                       {"share", pair.share}});
  }
  context.report({{"views", section}});
  const auto least = std::ranges::min_element(views, {}, &estimate::ViewConsistency::share);
  if (least == views.end()) return;
  context.print(
      fmt::format("views agree on at least {:.0f} % of their common flat surfaces; least: {} and {}, on {}",
                  100 * least->share, least->view, least->other, in_words(least->orientation)));
}

void report(const estimate::RecordingLags& lags, const PlateTrajectory& plate, Context& context) {
  const auto recordings = data::recordings_of(plate);
  const auto& lasers = context.rig().lasers;
  std::string words = fmt::format(
      "{} recordings, each with lags of its own: eta there less the mean over all [ms]", recordings.size());
  auto section = nlohmann::json::array();
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const auto& [begin, end, zero] = recordings[k];
    words += fmt::format("\n  {:>10.1f} to {:.1f} s ", begin, end);
    nlohmann::json own = {{"begin", begin}, {"end", end}, {"encoder_zero", zero}};
    for (std::size_t laser = 0; laser < lasers.size(); ++laser) {
      const auto row = static_cast<Eigen::Index>(k);
      const auto column = static_cast<Eigen::Index>(laser);
      const double error = lags.std_errors(row, column);
      const bool known = std::isfinite(error);
      words += known ? fmt::format(" {:>+9.4f} ± {:.4f}", 1e3 * lags.beyond(row, column), 1e3 * error)
                     : fmt::format(" {:>18}", "unknown");
      own["lags"][lasers[laser].name] = {{"beyond_mean", lags.beyond(row, column)},
                                         {"std_error", known ? nlohmann::json(error) : nlohmann::json()}};
    }
    section.push_back(own);
  }
  context.print(words);
  context.report({{"recordings", section}});
}

}  // namespace crisp::calibrate
