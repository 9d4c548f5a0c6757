// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/hub_timings.hpp"

#include <algorithm>

#include <crisp/error.hpp>

namespace crisp::clock {
namespace {

DeviceStamps stamps_of(const std::string& device, const AlignmentSettings& settings) {
  const auto standing =
      settings.source == TimeSource::receipt ? StandingClock::by_receipt : StandingClock::leave_out;
  return {device, WindowedClockFit(device, settings.drift), 0, standing};
}

std::vector<ScanTimestamper> tracks_of(const Rig& rig, const AlignmentSettings& settings) {
  std::vector<ScanTimestamper> tracks;
  for (const auto& laser : rig.lasers) {
    tracks.emplace_back(laser, stamps_of(laser.name, settings), settings.source,
                        settings.mirror_half_width.value_or(0));
  }
  return tracks;
}

}  // namespace

HubTimings::HubTimings(const Rig& rig, const AlignmentSettings& settings)
    : rig_(rig),
      settings_(settings),
      lasers_(tracks_of(rig, settings)),
      plate_(rig.plate, stamps_of(rig.plate.name, settings), settings.source) {}

void HubTimings::begin_anew() {
  lasers_ = tracks_of(rig_, settings_);
  const auto before = plate_.latest_reading();
  plate_ = EncoderTimestamper(rig_.plate, stamps_of(rig_.plate.name, settings_), settings_.source);
  if (before) plate_.follow_on(*before);
  unknown_lasers_ = 0;
  handed_out_ = 0;
  back_in_time_ = 0;
  begin_.reset();
}

double HubTimings::arrive(std::int64_t receipt_ns) {
  pauses_.hear(receipt_ns);
  if (!begun_) epoch_ns_ = clocks::epoch_of_run(receipt_ns);
  const double hub = 1e-9 * static_cast<double>(receipt_ns - epoch_ns_);
  if (!begun_) now_ = hub;
  if (!begin_) begin_ = hub;
  begun_ = true;
  if (hub < now_ - 1) ++back_in_time_;
  now_ = std::max(now_, hub);
  return hub;
}

ScanTimestamper* HubTimings::track_of(const Scan& scan) {
  if (scan.laser < lasers_.size()) return &lasers_[scan.laser];
  ++unknown_lasers_;
  return nullptr;
}

std::shared_ptr<const Measurements> HubTimings::measurements_of(const TimedScan& scan) {
  ++handed_out_;
  auto measurements = measurements_.get();
  fill_measurements(scan, lasers_[scan.scan->laser].laser(), epoch_ns_, *measurements);
  lasers_[scan.scan->laser].count_beams(*scan.scan, *measurements);
  return measurements;
}

std::uint64_t HubTimings::scans_left_out() const {
  std::uint64_t received = unknown_lasers_;
  for (const auto& laser : lasers_) received += laser.report().received + laser.without_ranges();
  return received - handed_out_;
}

bool HubTimings::has_scans() const {
  return std::ranges::any_of(lasers_, [](const auto& laser) { return laser.clock().stamps() > 0; });
}

bool HubTimings::has_readings() const { return plate_.clock().stamps() > 1; }

void HubTimings::refuse_if_missing() const {
  if (!has_scans()) {
    throw Error("there is no scan of any laser of the rig",
                "check the addresses in the rig, and what was lost of the recording");
  }
  const DeviceReport plate = plate_.report(begin_.value_or(now_), now_);
  if (!has_readings() && plate.standing > 0) {
    throw Error(
        plate.device + ": its clock stands still: " + std::to_string(plate.standing) + " of " +
            std::to_string(plate.received) +
            " readings carry the stamp of their predecessor, so that none can be placed in time",
        "have the encoder's sentences carry its running microseconds; clock.receipt places by receipt times instead");
  }
  if (plate.stamps == 1) {
    throw Error("there is a single encoder reading (" + plate.device + ")",
                "check the recording: the plate's angle is known between two readings only");
  }
  if (!has_readings()) {
    throw Error(
        "there is no encoder reading (" + plate_.clock().device() + ")",
        "check the plate's address in the rig, or the recording: beams cannot be placed without the plate's angle");
  }
}

void HubTimings::finish_clocks() {
  for (auto& laser : lasers_) laser.clock().finish();
  plate_.clock().finish();
}

std::vector<DeviceReport> HubTimings::reports() const {
  std::vector<DeviceReport> reports;
  const double begin = begin_.value_or(now_);
  for (const auto& laser : lasers_) reports.push_back(laser.report(begin, now_));
  reports.push_back(plate_.report(begin, now_));
  return reports;
}

}  // namespace crisp::clock
