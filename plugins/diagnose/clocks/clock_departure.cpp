// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/clock_departure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/clocks/envelope.hpp"
#include "pipeline/clocks/series.hpp"
#include "plugins/diagnose/clocks/clock_curve.hpp"
#include "plugins/diagnose/clocks/device_jumps.hpp"
#include "plugins/diagnose/noise/permutation_test.hpp"

namespace crisp::diagnose {
namespace {

using clocks::Envelope;

constexpr std::size_t kMin = 64;  // minimum number of stamps for a test

/// Stamp at which the device's own time jumps most, and whether the jump equals the envelope's step.
struct JumpThere {
  std::size_t stamp = 0;
  bool is_the_step = false;
};

/// @param window  the envelope steps before this window
/// @param step    [s] of the envelope; a forward jump of the device's clock makes telegrams appear earlier
JumpThere jump_about(std::span<const CountedStamp> stamps, const Envelope& envelope, std::size_t window,
                     double step) {
  const std::size_t end = envelope.first[std::min(window + 1, envelope.stamp.size())];
  const std::size_t at = largest_device_jump(stamps, envelope.first[window - 1], end);
  return {.stamp = at, .is_the_step = std::abs(device_jump(stamps, at) + step) < 0.5 * std::abs(step)};
}

/// Whether the late minimum delays have no common level: after a latency step they scatter as before, during
/// a backlog they do not.
bool is_backlog(const Envelope& envelope, Eigen::Index before, const Eigen::VectorXd& line) {
  constexpr double kNoLevel = 0.25;  // scatter relative to the step
  const Eigen::Index n = envelope.lead.size();
  const double step = line[2];
  const Eigen::VectorXd levelled = envelope.lead - envelope.straight() * line.head(2);
  const auto late = step > 0 ? levelled.tail(n - before) : levelled.head(before);
  const double scatter = std::sqrt((late.array() - late.mean()).square().mean());
  return scatter > kNoLevel * std::abs(step);
}

void report_step(std::span<const CountedStamp> stamps, const Envelope& envelope, std::size_t window,
                 const Eigen::VectorXd& line, ClockDeparture& departure) {
  const double step = departure.size;
  const auto level = [&](double t) { return envelope.line(line, t); };
  const JumpThere jump = jump_about(stamps, envelope, window, step);
  std::size_t at = jump.stamp;
  double waits = 1;  // mean number of telegrams until one resolves the side of the step
  if (jump.is_the_step) {
    departure.kind = ClockDeparture::Kind::clock_step;
    departure.size = -step;
  } else {
    departure.kind = ClockDeparture::Kind::latency_step;
    const std::vector<clocks::Stamp> all = without_counts(stamps);
    at = std::clamp<std::size_t>(clocks::first_after(all, step, level), 1, stamps.size() - 1);
    waits = 1 / clocks::early_share(step > 0 ? std::span(all).first(at) : std::span(all).subspan(at), step,
                                    level);
  }
  // A stall would delay the step's time by the waiting time of its queue.
  const auto without_delay = [&](const clocks::Stamp& s, double beyond) {
    return clocks::receipt_of(s) - std::max(0.0, s.lead - level(clocks::receipt_of(s)) - beyond);
  };
  const double sent = without_delay(stamps[at].stamp, step);
  departure.at =
      std::max(sent, clocks::receipt_of(stamps.front().stamp));  // a step lies within the recording
  departure.at_std_error =
      waits * std::max(1e-6, sent - without_delay(stamps[at - 1].stamp, 0)) + (departure.at - sent);
}

/// How well each deviation describes the minimum delays.
struct SeriesModels {
  double constant = 0, drift = 0, step = 0;  ///< BIC
  std::size_t window = 0;                    ///< the step is before it
  double size = 0;                           ///< [s] of the step
};

/// @param columns  regressors of a drift (parabola) and of the steps
/// @param curve    of a drift that varies
SeriesModels models_of(const Envelope& envelope, const Eigen::MatrixXd& columns,
                       const std::optional<ClockCurve>& curve) {
  const Eigen::MatrixXd base = envelope.straight();
  const Eigen::MatrixXd steps = columns.rightCols(columns.cols() - 1);
  const clocks::SeriesFit bend = clocks::best_in_series(base, columns.leftCols(1), envelope.lead);
  const clocks::SeriesFit step = clocks::best_in_series(base, steps, envelope.lead);
  const double whole = clocks::off_base(base, envelope.lead).squaredNorm();
  const double least = static_cast<double>(envelope.lead.size()) * kStampQuantum * kStampQuantum;
  const auto bic = [&](double squares, double of_its_own) {
    return bic_of_series(std::max(least, squares), envelope.lead.size(),
                         static_cast<double>(base.cols()) + of_its_own);
  };
  // A parabola has one parameter, its size; a step also has its time.
  SeriesModels models{.constant = bic(whole, 0),
                      .drift = bic(whole - bend.product * bend.product, 1),
                      .step = bic(whole - step.product * step.product, 2),
                      .window = static_cast<std::size_t>(clocks::before_step(steps.col(step.column))),
                      .size = step.values[step.values.size() - 1]};
  if (curve)
    models.drift = std::min(models.drift, bic(curve->squares, static_cast<double>(curve->parameters)));
  return models;
}

/// Other deviations that could explain the minimum delays, with the Bayes factors against them.
std::vector<ClockDeparture::Competitor> competitors_of(std::span<const CountedStamp> stamps,
                                                       const Envelope& envelope, const SeriesModels& models,
                                                       ClockDeparture::Kind kind) {
  using Kind = ClockDeparture::Kind;
  const JumpThere jump = jump_about(stamps, envelope, models.window, models.size);
  const bool is_drift = kind == Kind::drift || kind == Kind::varying_drift;
  const double own = is_drift ? models.drift : models.step;
  const auto odds = [own](double other) { return (other - own) / 2 / std::numbers::ln10; };
  std::vector<ClockDeparture::Competitor> competitors = {
      {.kind = {}, .log10_bayes_factor = odds(models.constant)}};
  if (is_drift) {
    competitors.push_back({.kind = jump.is_the_step ? Kind::clock_step : Kind::latency_step,
                           .log10_bayes_factor = odds(models.step)});
  } else {
    const double for_clock = log10_odds_of_jump(stamps, jump.stamp, -models.size);
    competitors.push_back({.kind = Kind::drift, .log10_bayes_factor = odds(models.drift)});
    competitors.push_back({.kind = kind == Kind::clock_step ? Kind::latency_step : Kind::clock_step,
                           .log10_bayes_factor = kind == Kind::clock_step ? for_clock : -for_clock});
  }
  // Receipt times that jump by years give no finite Bayes factor.
  if (!std::ranges::all_of(competitors,
                           [](const auto& one) { return std::isfinite(one.log10_bayes_factor); }))
    return {};
  std::ranges::stable_sort(competitors, {}, &ClockDeparture::Competitor::log10_bayes_factor);
  return competitors;
}

}  // namespace

std::optional<ClockDeparture> clock_departure(std::span<const CountedStamp> stamps, std::size_t tests,
                                              std::uint64_t seed) {
  if (stamps.size() < kMin) return std::nullopt;
  constexpr Eigen::Index kMargin = 2;  // windows at either end
  const Envelope envelope = clocks::envelope_of(without_counts(stamps));
  const Eigen::MatrixXd columns = clocks::bend_and_steps(envelope.time, kMargin);
  const PermutationTest test = test_series(envelope.straight(), columns, envelope.lead, seed);
  ClockDeparture departure{.size = test.values[2],
                           .std_error = test.errors[2],
                           .skew = test.values[1],
                           .skew_std_error = test.errors[1],
                           .p_value = std::min(1.0, test.p_value * static_cast<double>(tests)),
                           .gain = test.gain};
  departure.gain.metric = "minimum delays about the clock";
  departure.gain.unit = "s";
  if (departure.p_value > kSignificantInSeries) return std::nullopt;
  // Constant receipt times, or ones that jump by years, give no finite size.
  if (!std::isfinite(departure.size) || !std::isfinite(departure.std_error)) return std::nullopt;
  if (test.column == 0) {
    // lead = skew t + drift t²/2
    departure.size *= 2;
    departure.std_error *= 2;
    departure.skew -= departure.size * envelope.time.mean();
    departure.skew_std_error = std::hypot(test.errors[1], departure.std_error * envelope.time.mean());
    departure.competitors =
        competitors_of(stamps, envelope, models_of(envelope, columns, {}), departure.kind);
    return departure;
  }
  const auto curve = smooth_curve(envelope, seed);
  const SeriesModels models = models_of(envelope, columns, curve);
  if (curve && models.drift < models.step) {
    departure.kind = ClockDeparture::Kind::varying_drift;
    departure.curve = curve->delay;
    departure.size = curve->size;
    departure.std_error = curve->std_error;
    departure.gain.before = curve->gain.before;
    departure.gain.after = curve->gain.after;
    departure.gain.ci95 = curve->gain.ci95;
    departure.competitors = competitors_of(stamps, envelope, models, departure.kind);
    return departure;
  }
  const Eigen::Index before = clocks::before_step(columns.col(test.column));
  const auto window = static_cast<std::size_t>(before);
  report_step(stamps, envelope, window, test.values, departure);
  if (departure.kind == ClockDeparture::Kind::latency_step && is_backlog(envelope, before, test.values)) {
    departure.kind = ClockDeparture::Kind::backlog;
    const double share = static_cast<double>(before) / static_cast<double>(envelope.lead.size());
    departure.size = std::abs(departure.size) * std::sqrt(share * (1 - share));
    return departure;
  }
  departure.competitors = competitors_of(stamps, envelope, models, departure.kind);
  return departure;
}

std::vector<CountedStamp> without_step(std::span<const CountedStamp> stamps,
                                       const ClockDeparture& departure) {
  std::vector<CountedStamp> corrected(stamps.begin(), stamps.end());
  if (!departure.is_step()) return corrected;
  for (CountedStamp& s : corrected) {
    if (clocks::receipt_of(s.stamp) < departure.at) continue;
    if (departure.kind == ClockDeparture::Kind::latency_step) {
      s.stamp.lead -= departure.size;
    } else {  // a step of the link does not change the receipt time
      s.stamp.device -= departure.size;
      s.stamp.lead += departure.size;
    }
  }
  return corrected;
}

std::optional<std::array<double, 2>> clock_step_interval(const std::optional<ClockDeparture>& departure) {
  if (!departure || departure->kind != ClockDeparture::Kind::clock_step) return std::nullopt;
  const double margin = 2 * departure->at_std_error;
  return std::array{departure->at - margin, departure->at + margin};
}

}  // namespace crisp::diagnose
