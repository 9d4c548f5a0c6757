// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/clock_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/clocks/envelope.hpp"
#include "pipeline/clocks/series.hpp"
#include "pipeline/clocks/unwrap.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/clocks/device_jumps.hpp"
#include "plugins/diagnose/noise/permutation_test.hpp"

namespace crisp {
namespace {

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
    const std::vector<Stamp> all = without_counts(stamps);
    at = std::clamp<std::size_t>(first_after(all, step, level), 1, stamps.size() - 1);
    waits = 1 / early_share(step > 0 ? std::span(all).first(at) : std::span(all).subspan(at), step, level);
  }
  // A stall would delay the step's time by the waiting time of its queue.
  const auto without_delay = [&](const Stamp& s, double beyond) {
    return receipt_of(s) - std::max(0.0, s.lead - level(receipt_of(s)) - beyond);
  };
  const double sent = without_delay(stamps[at].stamp, step);
  departure.at = std::max(sent, receipt_of(stamps.front().stamp));  // a step lies within the recording
  departure.at_std_error =
      waits * std::max(1e-6, sent - without_delay(stamps[at - 1].stamp, 0)) + (departure.at - sent);
}

/// Other deviations that could explain the minimum delays, with the Bayes factors against them.
///
/// @param columns  regressors of a drift (parabola) and of the steps
std::vector<ClockDeparture::Competitor> competitors_of(std::span<const CountedStamp> stamps,
                                                       const Envelope& envelope,
                                                       const Eigen::MatrixXd& columns,
                                                       ClockDeparture::Kind kind) {
  using Kind = ClockDeparture::Kind;
  const Eigen::MatrixXd base = envelope.straight();
  const Eigen::MatrixXd steps = columns.rightCols(columns.cols() - 1);
  const SeriesFit bend = best_in_series(base, columns.leftCols(1), envelope.lead);
  const SeriesFit step = best_in_series(base, steps, envelope.lead);
  const double whole = off_base(base, envelope.lead).squaredNorm();
  const double least = static_cast<double>(envelope.lead.size()) * kStampQuantum * kStampQuantum;
  const auto bic = [&](double product, double of_its_own) {
    return bic_of_series(std::max(least, whole - product * product), envelope.lead.size(),
                         static_cast<double>(base.cols()) + of_its_own);
  };
  const double constant_bic = bic(0, 0);
  const double drift_bic = bic(bend.product, 1);  // one parameter, its size; a step also has its time
  const double step_bic = bic(step.product, 2);
  const auto window = static_cast<std::size_t>(before_step(steps.col(step.column)));
  const double size = step.values[step.values.size() - 1];
  const JumpThere jump = jump_about(stamps, envelope, window, size);
  const double own = kind == Kind::drift ? drift_bic : step_bic;
  const auto odds = [own](double other) { return (other - own) / 2 / std::numbers::ln10; };
  std::vector<ClockDeparture::Competitor> competitors = {
      {.kind = {}, .log10_bayes_factor = odds(constant_bic)}};
  if (kind == Kind::drift) {
    competitors.push_back({.kind = jump.is_the_step ? Kind::clock_step : Kind::latency_step,
                           .log10_bayes_factor = odds(step_bic)});
  } else {
    const double for_clock = log10_odds_of_jump(stamps, jump.stamp, -size);
    competitors.push_back({.kind = Kind::drift, .log10_bayes_factor = odds(drift_bic)});
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

std::vector<Stamp> without_counts(std::span<const CountedStamp> stamps) {
  std::vector<Stamp> without_counts;
  without_counts.reserve(stamps.size());
  for (const auto& s : stamps) without_counts.push_back(s.stamp);
  return without_counts;
}

ClockLine line_of(std::vector<Stamp> stamps) {
  std::ranges::stable_sort(stamps, {}, &Stamp::device);
  double sum = 0;
  for (const Stamp& s : stamps) sum += s.device;
  return line_by_convex_hull(stamps, sum / static_cast<double>(stamps.size()));
}

void StampTrack::add(std::uint16_t counter, std::uint32_t device_us, std::int64_t receipt_ns) {
  constexpr std::int64_t kRestart = 1000;  // counts: repeated telegrams are not that late
  const DeviceStamp stamp{.receipt_ns = receipt_ns, .device_us = device_us};
  std::int64_t count = 0;
  if (stamps_.empty()) {
    first_ns_ = receipt_ns;
  } else {
    const std::int64_t steps = counter_.advance(counter, 1);
    if (steps <= 0 && steps > -kRestart) return;  // a repeated telegram
    count = stamps_.back().count + (steps > 0 ? steps : 1);
    device_us_ += elapsed(last_, stamp).device_us;
  }
  counter_.accept(counter);
  last_ = stamp;
  const double device = 1e-6 * static_cast<double>(device_us_);
  const double hub = 1e-9 * static_cast<double>(receipt_ns - first_ns_);
  stamps_.push_back({.count = count, .stamp = {.device = device, .lead = hub - device}});
}

ClockFacts clock_facts(std::span<const CountedStamp> stamps) {
  if (stamps.size() < kMinOfClock) return {};
  const std::vector<Stamp> all = without_counts(stamps);
  const ClockLine line = line_of(all);
  std::vector<double> delays;
  for (const Stamp& s : all) delays.push_back(s.lead - line.lead(s.device));
  std::ranges::sort(delays);
  constexpr double kMax = 0.95;
  return {.skew = line.slope,
          .skew_std_error = errors_of_line(all, line).slope,
          .delay_median = delays[delays.size() / 2],
          .delay_95 = delays[static_cast<std::size_t>(kMax * static_cast<double>(delays.size() - 1))]};
}

std::optional<ClockDeparture> clock_departure(std::span<const CountedStamp> stamps, std::size_t tests,
                                              std::uint64_t seed) {
  if (stamps.size() < kMin) return std::nullopt;
  constexpr Eigen::Index kMargin = 2;  // windows at either end
  const Envelope envelope = envelope_of(without_counts(stamps));
  const Eigen::MatrixXd columns = bend_and_steps(envelope.time, kMargin);
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
    departure.competitors = competitors_of(stamps, envelope, columns, departure.kind);
    return departure;
  }
  const Eigen::Index before = before_step(columns.col(test.column));
  const auto window = static_cast<std::size_t>(before);
  report_step(stamps, envelope, window, test.values, departure);
  if (departure.kind == ClockDeparture::Kind::latency_step && is_backlog(envelope, before, test.values)) {
    departure.kind = ClockDeparture::Kind::backlog;
    const double share = static_cast<double>(before) / static_cast<double>(envelope.lead.size());
    departure.size = std::abs(departure.size) * std::sqrt(share * (1 - share));
    return departure;
  }
  departure.competitors = competitors_of(stamps, envelope, columns, departure.kind);
  return departure;
}

std::vector<CountedStamp> without_step(std::span<const CountedStamp> stamps,
                                       const ClockDeparture& departure) {
  std::vector<CountedStamp> corrected(stamps.begin(), stamps.end());
  if (!departure.is_step()) return corrected;
  for (CountedStamp& s : corrected) {
    if (receipt_of(s.stamp) < departure.at) continue;
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

std::vector<std::span<const CountedStamp>> unbroken_segments(
    std::span<const CountedStamp> passes, const std::optional<std::array<double, 2>>& step_interval) {
  constexpr double kLeap = 0.1;  // of a turn; a mirror's rate changes less from turn to turn
  const auto turn = [&](std::size_t i) {
    const auto turns = static_cast<double>(std::max<std::int64_t>(1, passes[i].count - passes[i - 1].count));
    return (passes[i].stamp.device - passes[i - 1].stamp.device) / turns;
  };
  std::vector<double> periods;
  for (std::size_t i = 1; i < passes.size(); ++i) periods.push_back(turn(i));
  if (periods.empty()) return {passes};
  const double usual = median_in_place(periods);
  std::vector<std::span<const CountedStamp>> runs;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < passes.size(); ++i) {
    const bool is_uncertain = step_interval && receipt_of(passes[i - 1].stamp) <= (*step_interval)[1] &&
                              receipt_of(passes[i].stamp) >= (*step_interval)[0];
    if (!is_uncertain && std::abs(turn(i) - usual) <= kLeap * usual) continue;
    runs.push_back(passes.subspan(begin, i - begin));
    begin = i;
  }
  runs.push_back(passes.subspan(begin));
  return runs;
}

std::optional<MirrorFacts> mirror_facts(std::span<const CountedStamp> passes,
                                        const std::optional<std::array<double, 2>>& step_interval) {
  constexpr std::size_t kMinPieces = 8;  // fewer give no variance
  MirrorFacts facts;
  double time = 0;
  double turns = 0;
  for (const auto run : unbroken_segments(passes, step_interval)) {
    for (std::size_t i = 0; i + kTurnsOfPiece < run.size(); i += kTurnsOfPiece) {
      const CountedStamp& from = run[i];
      const CountedStamp& to = run[i + kTurnsOfPiece];
      const double lasted = to.stamp.device - from.stamp.device;
      const auto turned = static_cast<double>(to.count - from.count);
      facts.periods.push_back(lasted / turned);
      facts.begin.push_back(receipt_of(from.stamp));
      time += lasted;
      turns += turned;
    }
  }
  if (facts.periods.size() < kMinPieces) return std::nullopt;
  facts.period = time / turns;
  double squares = 0;
  for (const double period : facts.periods) squares += std::pow(period - facts.period, 2);
  const auto pieces = static_cast<double>(facts.periods.size());
  const double spread = std::sqrt(squares / (pieces - 1));
  facts.wander = spread / facts.period;
  facts.period_std_error = std::hypot(spread / std::sqrt(pieces), kStampQuantum / turns);
  return facts;
}

MirrorFacts on_hubs_clock(MirrorFacts facts, const ClockFacts& clock) {
  if (std::isnan(clock.skew)) return facts;
  facts.period_std_error = std::hypot(facts.period_std_error, facts.period * clock.skew_std_error);
  facts.period *= 1 + clock.skew;
  for (double& period : facts.periods) period *= 1 + clock.skew;
  return facts;
}

Gain gain_over_nominal(const MirrorFacts& facts, double nominal, std::uint64_t seed) {
  const auto n = static_cast<Eigen::Index>(facts.periods.size());
  const Eigen::VectorXd excess = Eigen::Map<const Eigen::VectorXd>(facts.periods.data(), n).array() - nominal;
  Gain gain = gain_in_series(Eigen::MatrixXd(n, 0), Eigen::VectorXd::Ones(n), excess, seed);
  gain.metric = "period about the prediction";
  gain.unit = "s";
  return gain;
}

}  // namespace crisp
