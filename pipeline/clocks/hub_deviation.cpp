// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/hub_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::clocks {
namespace {

constexpr double kSmallestDeviation = 50e-6;  // [s] of a deviation that is worth taking out
constexpr std::size_t kMinStamps = 64;        // of a device
constexpr std::size_t kOfStretch = 8;         // stamps of the slowest device, about
constexpr std::size_t kMinStretches = 8;
constexpr std::size_t kMaxStretches = 1200;
constexpr double kAgree = 0.35;  // what the others' deviation leaves of a device's, over what it was
constexpr double kNoises = 2.5;  // delays are skewed: their scatter is larger than it mostly is
const double kNone = std::numeric_limits<double>::quiet_NaN();

using Series = std::vector<double>;  // a value a stretch of time [s]; NaN where there is none

double rms(const Series& series, double kept = 1) {
  std::vector<double> squares;
  for (const double value : series) {
    if (std::isfinite(value)) squares.push_back(value * value);
  }
  std::ranges::sort(squares);
  squares.resize(static_cast<std::size_t>(std::ceil(kept * static_cast<double>(squares.size()))));
  double sum = 0;
  for (const double square : squares) sum += square;
  return squares.empty() ? 0 : std::sqrt(sum / static_cast<double>(squares.size()));
}

Series difference(const Series& a, const Series& b) {
  Series result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] - b[i];
  return result;
}

/// A straight line by least squares.
struct Line {
  double constant = 0;
  double slope = 0;  // a second
};
/// @param times  [s] of the series' values
Line line_of(const Series& series, const std::vector<double>& times) {
  double n = 0, t = 0, tt = 0, v = 0, tv = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!std::isfinite(series[i])) continue;
    n += 1;
    t += times[i];
    tt += times[i] * times[i];
    v += series[i];
    tv += times[i] * series[i];
  }
  const double determinant = n * tt - t * t;
  const double slope = determinant > 0 ? (n * tv - t * v) / determinant : 0;
  return {.constant = n > 0 ? (v - slope * t) / n : 0, .slope = slope};
}

Series without_line(const Series& series, const std::vector<double>& times) {
  const Line line = line_of(series, times);
  Series left = series;
  for (std::size_t i = 0; i < left.size(); ++i) left[i] -= line.constant + line.slope * times[i];
  return left;
}

/// Typical change of a series from one value to the next.
double usual_change(const Series& series) {
  std::vector<double> changes;
  for (std::size_t i = 1; i < series.size(); ++i) {
    if (std::isfinite(series[i] - series[i - 1])) changes.push_back(series[i] - series[i - 1]);
  }
  return changes.empty() ? 0 : statistics::median_in_place(changes);
}

/// How uneven a series is from one value to the next [s]: its noise, where it changes slowly.
double noise_of(const Series& series) {
  std::vector<double> bends;
  for (std::size_t i = 2; i < series.size(); ++i) {
    const double bend = series[i] - 2 * series[i - 1] + series[i - 2];
    if (std::isfinite(bend)) bends.push_back(std::abs(bend) / std::sqrt(6.0));
  }
  return bends.empty() ? HUGE_VAL
                       : std::max(1e-6, statistics::kMadToSigma * statistics::median_in_place(bends));
}

Series medians(const std::vector<Series>& all, std::size_t without) {
  Series result(all.front().size(), kNone);
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::vector<double> values;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (k != without && std::isfinite(all[k][i])) values.push_back(all[k][i]);
    }
    if (!values.empty()) result[i] = statistics::median_in_place(values);
  }
  return result;
}

/// Whether the series deviate alike.
bool agree(const std::vector<Series>& all) {
  std::size_t informative = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Series others = medians(all, k);
    const double common = rms(others);
    if (common < kSmallestDeviation) return false;
    const double noise = noise_of(all[k]);
    const double left = rms(difference(all[k], others), 0.95);
    if (left > kAgree * common + kNoises * noise) return false;
    if (left <= kAgree * common) ++informative;
  }
  return informative >= 2;
}

/// The series' mean, each weighted by its noise.
Series weighted_mean(const std::vector<Series>& all) {
  Series sum(all.front().size(), 0), weights(all.front().size(), 0);
  for (const Series& series : all) {
    const double weight = 1 / std::pow(noise_of(series), 2);
    for (std::size_t i = 0; i < series.size(); ++i) {
      if (!std::isfinite(series[i])) continue;
      sum[i] += weight * series[i];
      weights[i] += weight;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = weights[i] > 0 ? sum[i] / weights[i] : kNone;
  return sum;
}

}  // namespace

/// Stretches of time, and the least leads of each device in them.
class DeviationSeries {
 public:
  explicit DeviationSeries(std::span<const std::vector<ReceivedStamp>> devices) {
    double first = HUGE_VAL, last = -HUGE_VAL, width = 0.05;
    for (const auto& stamps : devices) {
      if (stamps.size() < kMinStamps) continue;
      devices_.push_back(&stamps);
      const double span = stamps.back().hub - stamps.front().hub;
      first = std::min(first, stamps.front().hub);
      last = std::max(last, stamps.back().hub);
      width = std::max(width, kOfStretch * span / static_cast<double>(stamps.size()));
    }
    if (devices_.size() < 2) return;
    begin_ = first;
    count_ = static_cast<std::size_t>(std::clamp((last - first) / width, 0.0, double{kMaxStretches}));
    width_ = (last - first) / static_cast<double>(std::max<std::size_t>(1, count_));
  }

  bool is_enough() const { return devices_.size() >= 2 && count_ >= kMinStretches; }

  /// The least leads, less what is known of the deviation, without each device's line.
  std::vector<Series> least_leads(const HubDeviation& known) const {
    const std::vector<double> times = times_without(known);
    std::vector<Series> all;
    for (const auto* stamps : devices_) {
      const double skew = usual_change(least_leads(*stamps, known, 0)) / width_;
      all.push_back(without_line(least_leads(*stamps, known, skew), times));
    }
    return all;
  }

  /// The devices' skew that the deviation leaves, in the middle of them.
  double common_skew(const HubDeviation& known) const {
    const std::vector<double> times = times_without(known);
    std::vector<double> skews;
    for (const auto* stamps : devices_) skews.push_back(line_of(least_leads(*stamps, known, 0), times).slope);
    return statistics::median_in_place(skews);
  }

  /// Adds what is left of it.
  void add(const Series& more, HubDeviation& known) const {
    HubDeviation sum;
    sum.steps_ = known.steps_;
    sum.width_ = width_;
    for (std::size_t i = 0; i < count_; ++i) {
      const double time = middle(i);
      if (!std::isfinite(more[i]) || sum.is_unsure(time)) continue;
      sum.times_.push_back(time);
      sum.values_.push_back(known.at(time) + more[i]);
    }
    if (!sum.times_.empty()) known = std::move(sum);
  }

  /// Sudden changes of a series, by far more than before and after.
  std::vector<HubDeviation::Step> steps_of(const Series& series) const {
    std::vector<HubDeviation::Step> steps;
    const double least = std::max(2 * kSmallestDeviation, 8 * noise_of(series));
    constexpr std::size_t kAround = 3;
    std::vector<std::size_t> known;  // where the hub's clock was set forward, nothing was received
    for (std::size_t i = 0; i < series.size(); ++i) {
      if (std::isfinite(series[i])) known.push_back(i);
    }
    const auto change = [&](std::size_t i) { return series[known[i + 1]] - series[known[i]]; };
    const auto stretches = [&](std::size_t i) { return static_cast<double>(known[i + 1] - known[i]); };
    for (std::size_t i = kAround; i + kAround + 1 < known.size(); ++i) {
      std::vector<double> rates;
      for (std::size_t j = i - kAround; j <= i + kAround; ++j) rates.push_back(change(j) / stretches(j));
      const double by = change(i) - statistics::median_in_place(rates) * stretches(i);
      if (std::abs(by) < least) continue;
      steps.push_back(
          {.at = begin_ + 0.5 * static_cast<double>(known[i] + known[i + 1] + 1) * width_, .by = by});
    }
    constexpr std::size_t kMax = 32;  // a clock that is set so often is none
    return steps.size() > kMax ? std::vector<HubDeviation::Step>() : steps;
  }

  /// A steady rate of the hub's clock is the devices' skew: the deviation is left with none that it mostly
  /// has, unless the devices would all be off by more than clocks are.
  void take_out_rate(HubDeviation& deviation) const {
    constexpr double kMaxCommonSkew = 300e-6;
    add_rate(-usual_change(deviation.values_) / width_, deviation);
    const double common = common_skew(deviation);
    if (std::abs(common) > kMaxCommonSkew) add_rate(common, deviation);
  }

  /// A deviation by steps alone.
  HubDeviation with_steps(std::vector<HubDeviation::Step> steps) const {
    HubDeviation deviation;
    deviation.steps_ = std::move(steps);
    deviation.width_ = width_;
    for (std::size_t i = 0; i < count_; ++i) {
      if (deviation.is_unsure(middle(i))) continue;
      double value = 0;
      for (const auto& step : deviation.steps_) value += step.at < middle(i) ? step.by : 0;
      deviation.times_.push_back(middle(i));
      deviation.values_.push_back(value);
    }
    return deviation;
  }

 private:
  std::size_t index(double hub) const {
    const double i = std::max(0.0, (hub - begin_) / width_);
    return std::min(static_cast<std::size_t>(i), count_ - 1);
  }
  Series least_leads(const std::vector<ReceivedStamp>& stamps, const HubDeviation& known, double skew) const {
    Series least(count_, kNone);
    for (const ReceivedStamp& stamp : stamps) {
      if (known.is_unsure(stamp.hub)) continue;
      const double lead = stamp.lead - known.at(stamp.hub);
      const std::size_t i = index(stamp.hub);
      const double there = lead + skew * (middle(i) - stamp.hub);
      if (!(least[i] <= there)) least[i] = there;
    }
    return least;
  }
  double middle(std::size_t stretch) const { return begin_ + (static_cast<double>(stretch) + 0.5) * width_; }
  /// [s] Middles of the stretches on a uniform clock: skews do not add up over a time that was left out.
  std::vector<double> times_without(const HubDeviation& known) const {
    std::vector<double> times(count_);
    for (std::size_t i = 0; i < count_; ++i) times[i] = middle(i) - known.at(middle(i));
    return times;
  }
  static void add_rate(double rate, HubDeviation& deviation) {
    if (deviation.times_.empty()) return;
    const auto uniform = [&](std::size_t i) { return deviation.times_[i] - deviation.values_[i]; };
    const double first_time = uniform(0), first = deviation.values_.front();
    for (std::size_t i = 0; i < deviation.times_.size(); ++i) {
      deviation.values_[i] += rate * (uniform(i) - first_time) - first;
    }
  }

  std::vector<const std::vector<ReceivedStamp>*> devices_;
  double begin_ = 0;  // [s]
  double width_ = 1;  // [s]
  std::size_t count_ = 0;
};

double HubDeviation::at(double hub) const {
  if (times_.empty()) return 0;
  const auto next = static_cast<std::size_t>(std::ranges::upper_bound(times_, hub) - times_.begin());
  if (next == 0) return values_.front();
  if (next == times_.size()) return values_.back();
  const auto is_between = [&](const Step& step) {
    return step.at > times_[next - 1] && step.at < times_[next];
  };
  const auto step = std::ranges::find_if(steps_, is_between);
  if (step != steps_.end()) return values_[hub < step->at ? next - 1 : next];
  const double share = (hub - times_[next - 1]) / (times_[next] - times_[next - 1]);
  return values_[next - 1] + share * (values_[next] - values_[next - 1]);
}

bool HubDeviation::is_unsure(double hub) const {
  // Set forward, the clock left out a time of which `at` is the middle; set back, it had a time twice.
  const auto reach = [](const Step& step) { return step.by > 0 ? step.by / 2 : -step.by; };
  return std::ranges::any_of(
      steps_, [&](const Step& step) { return std::abs(hub - step.at) < width_ + reach(step); });
}

double HubDeviation::largest() const {
  if (values_.empty()) return 0;
  const auto [least, most] = std::ranges::minmax(values_);
  return most - least;
}

std::optional<HubDeviation> find_hub_deviation(std::span<const std::vector<ReceivedStamp>> devices) {
  constexpr int kRounds =
      3;  // where leads rise, the least of a stretch is its first, until the rise is known
  const DeviationSeries series(devices);
  if (!series.is_enough()) return std::nullopt;
  const std::vector<Series> first = series.least_leads({});
  if (!agree(first)) return std::nullopt;
  HubDeviation found = series.with_steps(series.steps_of(weighted_mean(first)));
  for (int round = 0; round < kRounds; ++round) {
    series.add(weighted_mean(series.least_leads(found)), found);
    series.take_out_rate(found);
  }
  return found;
}

}  // namespace crisp::clocks
