// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/clock_stamps.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/clocks/envelope.hpp"
#include "pipeline/clocks/unwrap.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/noise/permutation_test.hpp"

namespace crisp::diagnose {

using clocks::Stamp;

std::vector<Stamp> without_counts(std::span<const CountedStamp> stamps) {
  std::vector<Stamp> without_counts;
  without_counts.reserve(stamps.size());
  for (const auto& s : stamps) without_counts.push_back(s.stamp);
  return without_counts;
}

clocks::ClockLine line_of(std::vector<Stamp> stamps) {
  std::ranges::stable_sort(stamps, {}, &Stamp::device);
  double sum = 0;
  for (const Stamp& s : stamps) sum += s.device;
  return clocks::line_by_convex_hull(stamps, sum / static_cast<double>(stamps.size()));
}

void StampTrack::add(std::uint16_t counter, std::uint32_t device_us, std::int64_t receipt_ns) {
  constexpr std::int64_t kRestart = 1000;  // counts: repeated telegrams are not that late
  const clocks::DeviceStamp stamp{.receipt_ns = receipt_ns, .device_us = device_us};
  std::int64_t count = 0;
  if (stamps_.empty()) {
    first_ns_ = receipt_ns;
  } else {
    const std::int64_t steps = counter_.advance(counter, 1);
    if (steps <= 0 && steps > -kRestart) return;  // a repeated telegram
    count = stamps_.back().count + (steps > 0 ? steps : 1);
    device_us_ += clocks::elapsed(last_, stamp).device_us;
  }
  counter_.accept(counter);
  last_ = stamp;
  const double device = 1e-6 * static_cast<double>(device_us_);
  const double hub = 1e-9 * static_cast<double>(receipt_ns - first_ns_);
  stamps_.push_back({.count = count, .stamp = {.device = device, .lead = hub - device}});
}

void StampTrack::take_out(const clocks::HubDeviation& deviation, double hub_s) {
  const auto hub = [&](const CountedStamp& s) { return hub_s + clocks::receipt_of(s.stamp); };
  std::erase_if(stamps_, [&](const CountedStamp& s) { return deviation.is_unsure(hub(s)); });
  for (CountedStamp& s : stamps_) s.stamp.lead -= deviation.at(hub(s));
}

ClockFacts clock_facts(std::span<const CountedStamp> stamps) {
  if (stamps.size() < kMinOfClock) return {};
  const std::vector<Stamp> all = without_counts(stamps);
  const clocks::ClockLine line = line_of(all);
  std::vector<double> delays;
  for (const Stamp& s : all) delays.push_back(s.lead - line.lead(s.device));
  std::ranges::sort(delays);
  constexpr double kMax = 0.95;
  return {.skew = line.slope,
          .skew_std_error = clocks::errors_of_line(all, line).slope,
          .delay_median = delays[delays.size() / 2],
          .delay_95 = delays[static_cast<std::size_t>(kMax * static_cast<double>(delays.size() - 1))]};
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
  const double usual = statistics::median_in_place(periods);
  std::vector<std::span<const CountedStamp>> runs;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < passes.size(); ++i) {
    const bool is_uncertain = step_interval &&
                              clocks::receipt_of(passes[i - 1].stamp) <= (*step_interval)[1] &&
                              clocks::receipt_of(passes[i].stamp) >= (*step_interval)[0];
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
      facts.begin.push_back(clocks::receipt_of(from.stamp));
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

}  // namespace crisp::diagnose
