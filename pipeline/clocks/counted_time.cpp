// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/counted_time.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::clocks {
namespace {

constexpr std::size_t kKept = 16;     // intervals that predict the next one
constexpr std::size_t kEnough = 8;    // of them for an estimate of their scatter
constexpr std::size_t kMany = 128;    // intervals for a sure estimate: sixteen may be even by chance
constexpr std::size_t kSure = 4;      // even intervals after a jump
constexpr double kMinJump = 0.25e-3;  // [s] real mirrors' stamps are up to 0.17 ms off their prediction
constexpr double kManyTimes = 12;     // what intervals differ by (median)
constexpr double kOfSecond = 7;       // times the second largest difference of the latest intervals

}  // namespace

void CountedTime::add(double seconds, std::int64_t steps, double hub) {
  confirmed_.reset();
  const auto jump = excess(seconds, steps, hub);
  if (!jump) remember(seconds / static_cast<double>(steps));
  if (trial_) {
    judge_trial(jump);
  } else if (jump) {
    trial_ = {.by = *jump};
    jumped_ += *jump;
  }
}

void CountedTime::begin_anew() {
  latest_.clear();
  spread_.clear();
  next_ = next_spread_ = 0;
  trial_.reset();
}

void CountedTime::judge_trial(std::optional<double> jump) {
  if (jump) {
    // Back where it was, a stamp was off. Anything else, and the intervals are not what they were.
    jumped_ -= trial_->by;
    if (std::abs(trial_->by + *jump) > std::max(kMinJump, 0.1 * std::abs(*jump))) latest_.clear();
    trial_.reset();
  } else if (++trial_->even == kSure) {
    confirmed_ = trial_->by;
    trial_.reset();
  }
}

std::optional<double> CountedTime::excess(double seconds, std::int64_t steps, double hub) const {
  if (latest_.size() < kEnough) return std::nullopt;
  const auto n = static_cast<double>(steps);
  if (std::abs(seconds - n * usual_) < n * kMinJump / 2) return std::nullopt;  // as nearly all
  std::vector<double> values = latest_;
  const double usual = statistics::median_in_place(values);
  const double excess = seconds - n * usual;
  if (std::abs(excess) < n * std::max(kMinJump, largest_by_chance(usual))) return std::nullopt;
  // Where receipts confirm the device's clock, the interval was real: nothing was sent for a while, and not
  // counted either, or the counted events are uneven.
  constexpr double kAgree = 0.25;
  constexpr double kNearlyAStep = 0.75;
  const double off_clock = std::abs(hub - seconds);
  const double off_count = std::abs(hub - n * usual);
  if (off_clock < kAgree * std::abs(excess)) return std::nullopt;
  if (excess > kNearlyAStep * usual && off_clock < off_count) return std::nullopt;
  return excess;
}

/// [s] By the median deviation of the latest intervals, or of many, whichever is larger. As long as these are
/// few, their median may be small by chance, and the second largest counts, too: the largest may be a
/// silence.
double CountedTime::largest_by_chance(double usual) const {
  std::vector<double> latest = latest_;
  for (double& value : latest) value = std::abs(value - usual);
  std::vector<double> many = spread_;
  double second = 0;
  if (many.size() < kMany / 2) {
    std::ranges::nth_element(latest, latest.end() - 2);
    second = *(latest.end() - 2);
  }
  const double of_many = many.empty() ? 0 : statistics::median_in_place(many);
  return std::max(kManyTimes * std::max(statistics::median_in_place(latest), of_many), kOfSecond * second);
}

void CountedTime::remember(double step) {
  if (latest_.size() >= kEnough && spread_.size() < kMany) {
    spread_.push_back(std::abs(step - usual_));
  } else if (spread_.size() == kMany) {
    spread_[next_spread_] = std::abs(step - usual_);
    next_spread_ = (next_spread_ + 1) % kMany;
  }
  if (latest_.size() < kKept) {
    latest_.push_back(step);
  } else {
    latest_[next_] = step;
    next_ = (next_ + 1) % kKept;
  }
  if (latest_.size() == kEnough || next_ % kEnough == 0) {
    std::vector<double> values = latest_;
    usual_ = statistics::median_in_place(values);
  }
}

}  // namespace crisp::clocks
