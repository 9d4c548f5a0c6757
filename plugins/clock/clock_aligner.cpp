// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <crisp/clock_aligner.hpp>

#include "pipeline/clocks/hub_forward_step.hpp"
#include "pipeline/data/recordings.hpp"
#include "plugins/clock/hub_timings.hpp"
#include "plugins/clock/received.hpp"

namespace crisp {
namespace {

using clock::Received;

constexpr double kWindow = 60;            // [s]
constexpr double kLongestWindow = 240;    // [s] bounds the memory
constexpr double kLookAhead = 1;          // [s] after a gap in the receipts
constexpr std::size_t kMaxHeld = 20'000;  // telegrams then: receipts may stand still
constexpr double kLate = 30;              // [s] a scan may come in so long after it was swept

/// Adds a step, or what a larger step at the same time left of itself to that one.
void add_step(const StampStep& step, std::vector<StampStep>& steps) {
  constexpr double kNear = 1;  // [s]
  const auto same = std::ranges::find_if(steps, [&](const StampStep& other) {
    return other.by > data::kPause && std::abs(other.at - step.at) < kNear;
  });
  if (same != steps.end())
    same->by += step.by;
  else
    steps.push_back(step);
}

/// One warning for a removed deviation of the hub's clock, and not one for each device.
void warn_of_hub_clock(AlignmentReport& report) {
  if (report.hub_deviation <= 0) return;
  std::string steps;
  if (!report.hub_steps.empty()) {
    const StampStep& largest = *std::ranges::max_element(
        report.hub_steps, {}, [](const StampStep& step) { return std::abs(step.by); });
    steps =
        fmt::format(" (set {} time(s), by {:+.3f} ms at {:.2f} s{})", report.hub_steps.size(),
                    1e3 * largest.by, largest.at, report.hub_steps.size() > 1 ? ", and less elsewhere" : "");
  }
  report.warnings.push_back(fmt::format(
      "the hub's clock deviates by up to {:.3f} ms from those of all devices{}: it was set or slewed, as by NTP, or the hub was busy. The deviation is corrected",
      1e3 * report.hub_deviation, steps));
}

}  // namespace

class ClockAligner::Windows {
 public:
  Windows(const Rig& rig, const AlignmentSettings& settings, AlignmentSink sink);

  void add(std::shared_ptr<const Scan> scan);
  void add(const PlateReading& reading);
  AlignmentReport finish();

 private:
  void receive(Received item);
  void judge_gap();
  void pass(const Received& item);
  double arrive(std::int64_t receipt_ns);
  void end_recording();
  void advance_windows();
  void take_out_hub_deviation();
  void take_out_steps();
  bool is_too_short() const;
  void settle(double begin, double end);
  void hand_out(double limit);
  bool idle() const;

  AlignmentSettings settings_;
  AlignmentSink sink_;
  clock::HubTimings tracks_;
  AlignmentReport report_;  ///< of recordings that have ended, and the hub's clock
  clocks::ForwardStep forward_step_;
  std::int64_t stepped_ns_ = 0;  ///< by how much the hub's clock was set forward, in all
  std::vector<Received> held_;   ///< after a gap in the receipts, until its cause is known
  double begin_ = 0;             ///< [s since the epoch] of the window that is being filled
  double length_;                ///< [s] of it
};

ClockAligner::Windows::Windows(const Rig& rig, const AlignmentSettings& settings, AlignmentSink sink)
    : settings_(settings),
      sink_(std::move(sink)),
      tracks_(rig, settings),
      length_(settings.window.value_or(kWindow)) {}

void ClockAligner::Windows::add(std::shared_ptr<const Scan> scan) {
  if (tracks_.track_of(*scan) != nullptr) receive(std::move(scan));
}

void ClockAligner::Windows::add(const PlateReading& reading) { receive(reading); }

void ClockAligner::Windows::receive(Received item) {
  if (stepped_ns_ != 0) clock::set_back(item, stepped_ns_);
  const std::int64_t receipt_ns = clock::receipt_of(item);
  const bool is_gap = settings_.source == TimeSource::clock && tracks_.ends_pause(receipt_ns);
  if (held_.empty() && !is_gap) return pass(item);
  forward_step_.after(clock::device_of(item), clock::stamp_of(item));
  held_.push_back(std::move(item));
  const double held = 1e-9 * static_cast<double>(receipt_ns - clock::receipt_of(held_.front()));
  if (std::abs(held) > kLookAhead || held_.size() >= kMaxHeld) judge_gap();
}

/// Takes out a step of the hub's clock; without one, what is held begins another recording.
void ClockAligner::Windows::judge_gap() {
  const std::int64_t step_ns = forward_step_.size_ns().value_or(0);
  forward_step_.forget_after();
  if (step_ns > 0) {
    stepped_ns_ += step_ns;
    const double by = 1e-9 * static_cast<double>(step_ns);
    report_.hub_steps.push_back({.at = tracks_.now(), .by = by});
    report_.hub_deviation = std::max(report_.hub_deviation, by);
  }
  for (Received& item : std::exchange(held_, {})) {
    if (step_ns > 0) clock::set_back(item, step_ns);
    pass(item);
  }
}

void ClockAligner::Windows::pass(const Received& item) {
  const double hub = arrive(clock::receipt_of(item));
  forward_step_.before(clock::device_of(item), clock::stamp_of(item));
  if (const auto* reading = std::get_if<PlateReading>(&item)) {
    tracks_.plate().add(*reading, hub);
  } else {
    const auto& scan = std::get<std::shared_ptr<const Scan>>(item);
    tracks_.lasers()[scan->laser].add(scan, hub);
  }
}

double ClockAligner::Windows::arrive(std::int64_t receipt_ns) {
  if (tracks_.ends_pause(receipt_ns)) end_recording();
  const double hub = tracks_.arrive(receipt_ns);
  advance_windows();
  return hub;
}

void ClockAligner::Windows::advance_windows() {
  while (tracks_.now() >= begin_ + 1.5 * length_) {
    if (idle()) {
      begin_ = tracks_.now();
      continue;
    }
    take_out_steps();
    if (is_too_short()) {
      length_ = std::min(2 * length_, kLongestWindow);
    } else {
      const double end = begin_ + length_;
      settle(begin_, end);
      hand_out(0.5 * (begin_ + end));
      begin_ = end;
    }
  }
}

/// A deviation common to all devices' clocks is the hub's.
void ClockAligner::Windows::take_out_hub_deviation() {
  std::vector<std::vector<clocks::ReceivedStamp>> stamps;
  for (const auto& laser : tracks_.lasers()) stamps.push_back(laser.clock().unsettled());
  stamps.push_back(tracks_.plate().clock().unsettled());
  const auto deviation = clocks::find_hub_deviation(stamps);
  if (!deviation) return;
  for (auto& laser : tracks_.lasers()) laser.clock().take_out(*deviation);
  tracks_.plate().clock().take_out(*deviation);
  for (const auto& step : deviation->steps())
    add_step({.at = step.begin(), .by = step.by}, report_.hub_steps);
  report_.hub_deviation = std::max(report_.hub_deviation, deviation->largest());
}

void ClockAligner::Windows::take_out_steps() {
  take_out_hub_deviation();
  for (auto& laser : tracks_.lasers()) laser.clock().take_out_steps();
  tracks_.plate().clock().take_out_steps();
}

bool ClockAligner::Windows::is_too_short() const {
  if (settings_.window || length_ >= kLongestWindow) return false;
  const double drift =
      settings_.drift * length_ * length_ / 8;  // of a line through the window from its clock
  const auto is_uncertain = [&](const auto& track) {
    return track.clock().uncertainty(begin_ + length_) > drift;
  };
  return is_uncertain(tracks_.plate()) || std::ranges::any_of(tracks_.lasers(), is_uncertain);
}

void ClockAligner::Windows::settle(double begin, double end) {
  for (auto& laser : tracks_.lasers()) laser.clock().settle(begin, end);
  tracks_.plate().clock().settle(begin, end);
}

void ClockAligner::Windows::hand_out(double limit) {
  clock::EncoderTimestamper& plate = tracks_.plate();
  const std::int64_t epoch_ns = tracks_.epoch_ns();
  std::vector<clock::TimedScan> scans;
  for (auto& laser : tracks_.lasers()) laser.take_before(limit, scans);
  if (scans.empty()) {
    plate.forget_before(limit - settings_.margin - kLate);
    return;
  }
  std::stable_sort(scans.begin(), scans.end(),
                   [](const clock::TimedScan& a, const clock::TimedScan& b) { return a.begin < b.begin; });
  double end = -std::numeric_limits<double>::infinity();
  for (const auto& scan : scans) end = std::max(end, scan.begin + scan.period);
  sink_.trajectory(
      plate.piece(scans.front().begin - settings_.margin, end + settings_.margin, epoch_ns, settings_.plate));
  for (auto& scan : scans) {
    auto measurements = tracks_.measurements_of(scan);
    scan.scan.reset();
    sink_.measurements(std::move(measurements));
  }
  plate.forget_before(limit - settings_.margin - kLate);
}

bool ClockAligner::Windows::idle() const {
  const auto is_idle = [](const auto& track) { return track.clock().idle(); };
  return is_idle(tracks_.plate()) && std::ranges::all_of(tracks_.lasers(), is_idle);
}

void ClockAligner::Windows::end_recording() {
  if (tracks_.has_scans() && tracks_.has_readings()) {
    take_out_steps();
    settle(begin_, std::nextafter(tracks_.now(), std::numeric_limits<double>::infinity()));
    tracks_.finish_clocks();
    hand_out(std::numeric_limits<double>::infinity());
    report_.append(tracks_.report());
  } else {
    ++report_.counts["recordings without any scan, or without two encoder readings"];
    const std::uint64_t scans = tracks_.scans_left_out();
    report_.counts["scans of recordings without two encoder readings"] += scans;
    if (scans > 0)
      report_.warnings.push_back(fmt::format(
          "{}: no data of it in one of several recordings with pauses between them: the {} scans of that recording are left out. Check that it was switched on, and that its packets were recorded",
          tracks_.plate().clock().device(), scans));
  }
  tracks_.begin_anew();
  length_ = settings_.window.value_or(kWindow);
  begin_ = tracks_.now();
}

AlignmentReport ClockAligner::Windows::finish() {
  judge_gap();
  if (report_.devices.empty()) tracks_.refuse_if_missing();
  end_recording();
  warn_of_hub_clock(report_);
  return report_;
}

ClockAligner::ClockAligner(const Rig& rig, const AlignmentSettings& settings, AlignmentSink sink)
    : windows_(std::make_unique<Windows>(rig, settings, std::move(sink))) {}

ClockAligner::~ClockAligner() = default;

void ClockAligner::add(std::shared_ptr<const Scan> scan) { windows_->add(std::move(scan)); }

void ClockAligner::add(const PlateReading& reading) { windows_->add(reading); }

AlignmentReport ClockAligner::finish() { return windows_->finish(); }

}  // namespace crisp
