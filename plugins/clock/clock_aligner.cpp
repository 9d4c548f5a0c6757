// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/clock_aligner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

constexpr double kWindow = 60;          // [s]
constexpr double kLongestWindow = 240;  // [s] bounds the memory
constexpr double kLate = 30;            // [s] a scan may come in so long after it was swept
constexpr std::int64_t kSecond_ns = 1'000'000'000;

DeviceStamps stamps_of(const std::string& device, const AlignmentSettings& settings) {
  return {device, FittedClock(device, settings.find, settings.drift), 0};
}

std::vector<LaserTrack> tracks_of(const Rig& rig, const AlignmentSettings& settings) {
  std::vector<LaserTrack> tracks;
  for (const auto& laser : rig.lasers) {
    tracks.emplace_back(laser, stamps_of(laser.name, settings), settings.source,
                        settings.mirror_half_width.value_or(0));
  }
  return tracks;
}

}  // namespace

ClockAligner::ClockAligner(const Rig& rig, const AlignmentSettings& settings, AlignmentSink sink)
    : settings_(settings),
      sink_(std::move(sink)),
      lasers_(tracks_of(rig, settings)),
      plate_(rig.plate, stamps_of(rig.plate.name, settings), settings.source),
      length_(settings.window.value_or(kWindow)) {}

double ClockAligner::arrive(std::int64_t receipt_ns) {
  if (!begun_) {
    epoch_ns_ = receipt_ns - ((receipt_ns % kSecond_ns) + kSecond_ns) % kSecond_ns;
    begun_ = true;
    now_ = 1e-9 * static_cast<double>(receipt_ns - epoch_ns_);
  }
  const double hub = 1e-9 * static_cast<double>(receipt_ns - epoch_ns_);
  if (hub < now_ - 1) ++back_in_time_;
  now_ = std::max(now_, hub);
  advance_windows();
  return hub;
}

void ClockAligner::add(std::shared_ptr<const Scan> scan) {
  if (scan->laser >= lasers_.size()) {
    ++unknown_lasers_;
    return;
  }
  const double hub = arrive(scan->receipt_ns);
  LaserTrack& laser = lasers_[scan->laser];
  laser.add(std::move(scan), hub);
}

void ClockAligner::add(const PlateReading& reading) { plate_.add(reading, arrive(reading.receipt_ns)); }

void ClockAligner::advance_windows() {
  while (now_ >= begin_ + 1.5 * length_) {
    if (idle()) {
      begin_ = now_;
    } else if (is_too_short()) {
      length_ = std::min(2 * length_, kLongestWindow);
    } else {
      const double end = begin_ + length_;
      settle(begin_, end);
      hand_out(0.5 * (begin_ + end));
      begin_ = end;
    }
  }
}

bool ClockAligner::is_too_short() const {
  if (settings_.window || length_ >= kLongestWindow) return false;
  const double drift =
      settings_.drift * length_ * length_ / 8;  // of a line through the window from its clock
  const auto doubtful = [&](const auto& track) {
    return track.clock().doubt(begin_, begin_ + length_) > drift;
  };
  return doubtful(plate_) || std::any_of(lasers_.begin(), lasers_.end(), doubtful);
}

void ClockAligner::settle(double begin, double end) {
  for (auto& laser : lasers_) laser.clock().settle(begin, end);
  plate_.clock().settle(begin, end);
}

void ClockAligner::hand_out(double limit) {
  std::vector<TimedScan> scans;
  for (auto& laser : lasers_) laser.take_before(limit, scans);
  if (scans.empty()) {
    plate_.forget_before(limit - settings_.margin - kLate);
    return;
  }
  std::stable_sort(scans.begin(), scans.end(),
                   [](const TimedScan& a, const TimedScan& b) { return a.begin < b.begin; });
  double end = -std::numeric_limits<double>::infinity();
  for (const auto& scan : scans) end = std::max(end, scan.begin + scan.period);
  sink_.trajectory(plate_.piece(scans.front().begin - settings_.margin, end + settings_.margin, epoch_ns_,
                                settings_.plate));
  for (auto& scan : scans) {
    sink_.measurements(measurements_of(scan, lasers_[scan.scan->laser].laser(), epoch_ns_));
    scan.scan.reset();
  }
  plate_.forget_before(limit - settings_.margin - kLate);
}

bool ClockAligner::idle() const {
  const auto is_idle = [](const auto& track) { return track.clock().idle(); };
  return is_idle(plate_) && std::all_of(lasers_.begin(), lasers_.end(), is_idle);
}

void ClockAligner::refuse_if_missing() const {
  if (std::all_of(lasers_.begin(), lasers_.end(),
                  [](const auto& l) { return l.report().clock.stamps == 0; })) {
    throw Error("there is no scan of any laser of the rig",
                "check the addresses in the rig, or what was recorded");
  }
  if (plate_.report().clock.stamps == 0) {
    throw Error("there is no reading of the plate (" + plate_.report().clock.device + ")",
                "check the plate's address in the rig, or what was recorded: without its angle nothing can "
                "be placed");
  }
}

AlignmentReport ClockAligner::finish() {
  refuse_if_missing();
  settle(begin_, std::nextafter(now_, std::numeric_limits<double>::infinity()));
  for (auto& laser : lasers_) laser.clock().finish();
  plate_.clock().finish();
  hand_out(std::numeric_limits<double>::infinity());
  return report();
}

}  // namespace crisp
