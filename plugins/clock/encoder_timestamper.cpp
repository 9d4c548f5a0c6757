// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/encoder_timestamper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/clocks/clock_line.hpp"
#include "pipeline/clocks/unwrap.hpp"

namespace crisp::clock {
namespace {

constexpr double kFastestChange = 100;  // [turns/s²] no plate spins up faster
constexpr double kSlack = 0.01;         // [turns] what times and counts may be off otherwise
constexpr std::uint64_t kMinConsecutiveJumps = 5;
constexpr double kLongestBlind = 0.05;  // [s] in which a plate goes on as before, within kSlack
constexpr std::ptrdiff_t kMarginReadings =
    2;  // readings beyond the requested ones, so that its ends are as smooth

/// Difference of two values of a 32-bit counter, forwards or back.
std::int32_t counted(std::uint32_t from, std::uint32_t to) { return static_cast<std::int32_t>(to - from); }

}  // namespace

EncoderTimestamper::EncoderTimestamper(const RigPlate& plate, DeviceStamps stamps, TimeSource source)
    : counts_per_revolution_(plate.counts_per_revolution),
      angle_per_count_(plate.angle_per_count()),
      stamps_(std::move(stamps)),
      source_(source) {
  if (!(plate.counts_per_revolution > 0)) {
    throw Error("the encoder of " + plate.name + " must have more than 0 counts a revolution",
                "correct counts_per_revolution in the rig");
  }
}

bool EncoderTimestamper::is_continuous(const clocks::DeviceStamp& from, const PlateReading& reading) {
  constexpr double kMaxDelay = 1;       // [s]
  constexpr double kLargestError = 60;  // [s] beyond which a wrap of the clock could be mistaken for chance
  const auto [hub_s, device_us] =
      clocks::elapsed(from, {.receipt_ns = reading.receipt_ns, .device_us = reading.device_us});
  const double tolerance = kMaxDelay + clocks::kMaxSkew * std::abs(hub_s);
  return tolerance < kLargestError && std::abs(1e-6 * static_cast<double>(device_us) - hub_s) < tolerance;
}

bool EncoderTimestamper::add(const PlateReading& reading, double hub) {
  if (before_) zero_is_new_ = !is_continuous(*before_, reading);
  before_.reset();
  const double receipt = hub - 1e-6 * reading.handover_us;  // as if it had been sent at once
  latest_ = {.receipt_ns = reading.receipt_ns, .device_us = reading.device_us};
  stamps_.trust_counter(reading.numbered);
  const auto arrival =
      stamps_.accept(reading.sequence, reading.device_us + static_cast<std::uint32_t>(reading.handover_us),
                     reading.receipt_ns, hub, reading.handover_us);
  if (arrival.kind == clocks::StampKind::repeated) return false;
  if (arrival.kind == clocks::StampKind::reset) {
    before_reset_ = {.last = last_, .ahead = ahead_, .zero_is_lost = zero_is_lost_};
    zero_is_lost_ = zero_is_lost_ || has_lost_zero(reading, receipt);
  }
  if (arrival.kind == clocks::StampKind::returned) undo_reset();
  if (source_ == TimeSource::receipt && taken_ > 0 && receipt <= last_.receipt) {
    ++simultaneous_;
    return true;
  }
  if (zero_is_lost_) {
    ++after_lost_zero_;
    return true;
  }
  Reading next{.device = 1e-6 * static_cast<double>(arrival.device_us - std::int64_t{reading.handover_us}),
               .receipt = receipt,
               .count = static_cast<std::int32_t>(reading.count)};
  if (taken_ > 0)
    next.count = last_.count + counted(static_cast<std::uint32_t>(last_.count + ahead_), reading.count);
  if (taken_ > 0 && (has_jumped(last_, next) || goes_on_from_jump(next))) {
    ++impossible_;
    classify_jump(next);
  } else {
    take(next);
  }
  return true;
}

void EncoderTimestamper::take(const Reading& next) {
  if (taken_ > 0) {
    interval_ = std::max(next.device - last_.device, 1e-6);
    rate_ = static_cast<double>(next.count - last_.count) / interval_;
  }
  jumped_.clear();
  ++taken_;
  last_ = next;
  readings_.push_back(next);
}

void EncoderTimestamper::classify_jump(const Reading& next) {
  // One such reading is damaged; several that go on from one another are right, and either the first of all
  // readings were damaged, or the count has jumped.
  if (!jumped_.empty() && has_jumped(jumped_.back(), next)) jumped_.clear();
  jumped_.push_back(next);
  if (jumped_.size() < kMinConsecutiveJumps) return;
  if (taken_ < kMinConsecutiveJumps) {
    readings_.clear();
    taken_ = 0;
    take(next);
  } else if (jumped_.front().device - last_.device < kLongestBlind) {
    continue_after_jump();
  } else {
    zero_is_lost_ = true;
  }
}

void EncoderTimestamper::continue_after_jump() {
  constexpr double kByChance = 2;  // [counts] that the plate may differ from its mean rate
  const std::vector<Reading> jumped = std::exchange(jumped_, {});
  const auto counts = [](const Reading& from, const Reading& to) {
    return static_cast<double>(to.count - from.count);
  };
  const double rate_after =
      counts(jumped.front(), jumped.back()) / std::max(jumped.back().device - jumped.front().device, 1e-6);
  const double gone = 0.5 * (rate_ + rate_after) * (jumped.front().device - last_.device);
  double jump = std::round(counts(last_, jumped.front()) - gone);
  // An encoder that counts anew at its index pulse.
  const double of_turns = counts_per_revolution_ * std::round(jump / counts_per_revolution_);
  const bool is_by_turns = of_turns != 0 && std::abs(jump - of_turns) <= kByChance;
  if (is_by_turns) jump = std::round(of_turns);
  const auto ahead = static_cast<std::int64_t>(jump);
  note_jump(jumped.front(), jump, is_by_turns);
  ahead_ += ahead;
  impossible_ -= jumped.size();
  for (Reading reading : jumped) {
    reading.count -= ahead;
    take(reading);
  }
}

void EncoderTimestamper::note_jump(const Reading& after, double counts, bool is_by_turns) {
  ++(is_by_turns ? count_jumps_.by_turns : count_jumps_.others);
  const double angle = counts * angle_per_count_;
  if (is_by_turns || std::abs(angle) <= std::abs(count_jumps_.largest)) return;
  count_jumps_.largest = angle;
  largest_jump_ = after;
}

EncoderTimestamper::CountJumps EncoderTimestamper::count_jumps() const {
  CountJumps jumps = count_jumps_;
  if (stamps_.map()) jumps.time = time(largest_jump_);
  return jumps;
}

double EncoderTimestamper::deviation(const Reading& from, const Reading& to) const {
  return std::abs(static_cast<double>(to.count - from.count) - rate_ * (to.device - from.device));
}

bool EncoderTimestamper::has_jumped(const Reading& from, const Reading& to) const {
  const double elapsed = to.device - from.device;
  const double of_whole_counts = 2 * (1 + elapsed / interval_);  // a coarse encoder shows its rate coarsely
  return deviation(from, to) >
         counts_per_revolution_ * (kSlack + kFastestChange * elapsed * elapsed) + of_whole_counts;
}

bool EncoderTimestamper::goes_on_from_jump(const Reading& next) const {
  return !jumped_.empty() && deviation(jumped_.back(), next) < deviation(last_, next);
}

void EncoderTimestamper::undo_reset() {
  if (zero_is_lost_ && !before_reset_.zero_is_lost) --after_lost_zero_;
  zero_is_lost_ = before_reset_.zero_is_lost;
  ahead_ = before_reset_.ahead;
  last_ = before_reset_.last;
  while (!readings_.empty() && readings_.back().device > last_.device) readings_.pop_back();
}

bool EncoderTimestamper::has_lost_zero(const PlateReading& reading, double receipt) const {
  const double change = counted(static_cast<std::uint32_t>(last_.count + ahead_), reading.count);
  const double residual_if_continued = std::abs(change - rate_ * (receipt - last_.receipt));
  const double residual_if_restarted = std::abs(counted(0, reading.count) - rate_ * 1e-6 * reading.device_us);
  return residual_if_restarted < residual_if_continued;
}

double EncoderTimestamper::time(const Reading& reading) const {
  return source_ == TimeSource::receipt ? reading.receipt : stamps_.map()->to_hub(reading.device);
}

std::optional<double> EncoderTimestamper::latest() const {
  if (readings_.empty() || !stamps_.map()) return {};
  return time(readings_.back());
}

PlateTrajectory EncoderTimestamper::piece(double begin, double end, std::int64_t epoch_ns,
                                          const PlateMotionSettings& settings) {
  if (readings_.empty() || !stamps_.map()) return {};
  const auto is_before = [&](double limit) {
    return [&, limit](const Reading& r) { return time(r) < limit; };
  };
  auto first = std::partition_point(readings_.begin(), readings_.end(), is_before(begin));
  auto last = std::partition_point(first, readings_.end(), is_before(end));
  first -= std::min(kMarginReadings, first - readings_.begin());
  last += std::min(kMarginReadings, readings_.end() - last);
  std::vector<double> times;
  std::vector<double> angles;
  times.reserve(static_cast<std::size_t>(last - first));
  angles.reserve(static_cast<std::size_t>(last - first));
  for (auto reading = first; reading != last; ++reading) {
    const double t = time(*reading);
    if (!times.empty() && t <= times.back()) continue;  // just after a reset, by the lines' errors
    times.push_back(t);
    angles.push_back(static_cast<double>(reading->count) * angle_per_count_);
  }
  angles = data::between_steps(times, angles, std::abs(angle_per_count_), settings.smoothing);
  std::vector<double> new_zeros;
  if (std::exchange(zero_is_new_, false) && !times.empty()) new_zeros.push_back(times.front());
  return {epoch_ns, std::move(times), std::move(angles), settings.max_gap, std::move(new_zeros)};
}

void EncoderTimestamper::forget_before(double hub) {
  const auto keep = std::find_if(readings_.begin(), readings_.end(),
                                 [&](const Reading& reading) { return reading.receipt >= hub; });
  readings_.erase(readings_.begin(), keep);
}

}  // namespace crisp::clock
