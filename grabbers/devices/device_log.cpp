// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/device_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace crisp {

double DeviceStatistics::rate() const {
  const auto heard_ns = last_ns - first_ns - paused_ns;
  const auto intervals = items - std::min(items, 1 + pauses);
  return intervals == 0 || heard_ns <= 0
             ? 0
             : static_cast<double>(intervals) / (1e-9 * static_cast<double>(heard_ns));
}

int DeviceStatistics::period_hint() const {
  constexpr double kSweep = 0.75;  // 270° of a turn: no scan is over before
  return median_handover && period && *median_handover < kSweep * *period ? -1 : 0;
}

DeviceLog::DeviceLog(DeviceKind kind, std::string name, Address address, std::uint16_t laser, Pauses* pauses)
    : laser_(laser), pauses_(pauses) {
  statistics_.kind = kind;
  statistics_.name = std::move(name);
  statistics_.address = std::move(address);
}

DeviceStatistics DeviceLog::statistics() const {
  auto statistics = statistics_;
  const bool laser = statistics.kind == DeviceKind::Laser;
  const auto missing = static_cast<std::int64_t>(tracker_.lost());
  statistics.losses.add(laser ? kTelegramsNeverCame : kReadingsNeverCame,
                        static_cast<std::uint64_t>(std::max<std::int64_t>(0, missing - unrequested_)));
  if (unrequested_ > 0) {
    statistics.notes.add("scans between the requested ones", static_cast<std::uint64_t>(unrequested_));
  }
  statistics.median_handover = handover_.value();
  statistics.period = period_.value();
  statistics.skew = clock_.skew();
  return statistics;
}

void DeviceLog::count_telegram(std::string_view kind) {
  constexpr std::size_t kMaxKinds = 256;  // what garbage can cost
  const bool full = statistics_.telegrams.all().size() >= kMaxKinds && statistics_.telegrams.of(kind) == 0;
  statistics_.telegrams.add(full ? "others" : kind);
}

/// Counter gaps across a pause between two recordings are no loss, and clocks may be others after it.
void DeviceLog::note_pause(std::uint32_t device_us, std::int64_t time_ns) {
  auto& s = statistics_;
  if (pauses_ == nullptr) return;
  pauses_->hear(time_ns);
  if (s.items == 0 || !pauses_->last_is_between(s.last_ns, time_ns)) return;
  ++s.pauses;
  s.paused_ns += time_ns - s.last_ns;
  tracker_.restart();
  clock_.restart();
  clock_.take(device_us, time_ns);
  last_scan_.reset();
}

bool DeviceLog::is_new(std::uint16_t counter, std::uint32_t device_us, std::int64_t time_ns, bool polled) {
  if (clock_.take(device_us, time_ns)) {
    note("restarts of the device's clock");
    tracker_.restart();
    last_scan_.reset();
  }
  note_pause(device_us, time_ns);
  const auto missing = static_cast<std::int64_t>(tracker_.lost());
  const auto verdict = tracker_.take(counter, device_us, time_ns);
  if (polled) unrequested_ += static_cast<std::int64_t>(tracker_.lost()) - missing;
  if (verdict == SequenceTracker::Verdict::Late) note("items that came late");
  const bool twice = verdict == SequenceTracker::Verdict::Duplicate;
  if (twice) note(polled ? "scans read twice by a client" : "items that came twice");
  return !twice;
}

void DeviceLog::note_time(std::uint32_t device_us, std::int64_t time_ns) {
  auto& s = statistics_;
  if (device_us == std::exchange(last_stamp_us_, device_us)) ++s.standing;
  if (s.items++ == 0) {
    s.first_ns = s.last_ns = time_ns;
    return;
  }
  const double silence = 1e-9 * static_cast<double>(time_ns - s.last_ns);
  if (silence > s.longest_silence) {
    s.longest_silence = silence;
    s.silence_ns = s.last_ns;
  }
  s.first_ns = std::min(s.first_ns, time_ns);
  s.last_ns = std::max(s.last_ns, time_ns);
}

std::shared_ptr<const Scan> DeviceLog::take(const ColaFrame& frame, EncoderWidths widths) {
  const auto telegram = parse_cola(frame.payload, frame.language);
  if (!telegram) {
    lose("telegrams of an unknown kind");
    return {};
  }
  if (const auto code = cola_error_code(*telegram)) {
    count_telegram(fmt::format("sFA {} ({})", *code, cola_error_text(*code)));
  } else {
    kind_.assign(telegram->command).append(1, ' ').append(telegram->name);
    count_telegram(kind_);
  }
  const bool scan =
      telegram->name == kScanDataName && (telegram->command == "sSN" || telegram->command == "sRA");
  return scan ? take_scan(*telegram, frame.completed_ns, widths) : nullptr;
}

void DeviceLog::lose_scan(std::string_view why) {
  lose(why);
  ++statistics_.unreadable;
}

std::shared_ptr<const Scan> DeviceLog::take_scan(const ColaTelegram& telegram, std::int64_t time_ns,
                                                 EncoderWidths widths) {
  const auto failure = decode_scan_data(telegram, widths, data_);
  if (failure != FieldFailure::None) {
    lose_scan(fmt::format("unreadable scan telegrams: {}", to_string(failure)));
    return {};
  }
  if (data_.appended > 0) note("scan telegrams with unknown fields at their end");
  if (data_.layer != 0) {  // a cone: the rig describes planes
    if (is_new(data_.telegram_counter, data_.transmission_time_us, time_ns)) {
      lose("scans of a tilted layer (only the layer at 0 degrees is read)");
    }
    return {};
  }
  auto scan = scans_.get();
  const auto refusal = to_scan(data_, laser_, time_ns, *scan);
  if (refusal != ScanFailure::None) {
    lose_scan(fmt::format("scan telegrams that hold no scan: {}", to_string(refusal)));
    return {};
  }
  const bool polled = telegram.command == "sRA";
  if (!is_new(scan->telegram_counter, scan->transmission_time_us, time_ns, polled)) return {};
  if (polled) scan->numbered = false;
  note_time(scan->transmission_time_us, time_ns);
  note_scan(*scan);
  return scan;
}

void DeviceLog::note_scan(const Scan& scan) {
  auto& s = statistics_;
  constexpr std::size_t kMaxSerialNumbers = 16;
  const bool known = std::find(s.serial_numbers.begin(), s.serial_numbers.end(), scan.serial_number) !=
                     s.serial_numbers.end();
  if (!known && s.serial_numbers.size() < kMaxSerialNumbers) s.serial_numbers.push_back(scan.serial_number);
  if (scan.serial_number != last_serial_number_.value_or(scan.serial_number)) ++s.serial_changes;
  last_serial_number_ = scan.serial_number;
  if (scan.device_status != 0) note("scans whose device reported an error or pollution");
  handover_.add(1e-6 * static_cast<std::uint32_t>(scan.transmission_time_us - scan.scan_time_us));
  if (last_scan_) {
    const auto turns = static_cast<std::uint16_t>(scan.scan_counter - last_scan_->first);
    const auto elapsed = static_cast<std::uint32_t>(scan.scan_time_us - last_scan_->second);
    if (turns > 0 && turns < 100 && elapsed > 0) period_.add(1e-6 * elapsed / turns);
  }
  last_scan_ = {scan.scan_counter, scan.scan_time_us};
  s.nominal_frequency = scan.scan_frequency;
  if (!scan.encoders.empty()) note_count(scan.encoders.front().position);
  const auto& first = scan.echoes.front();
  s.shape = {first.ranges.size(), scan.start_angle,          scan.angle_step,
             scan.echoes.size(),  !first.remissions.empty(), !scan.encoders.empty()};
}

void DeviceLog::note_count(std::uint32_t count) {
  const auto steps = static_cast<std::int32_t>(count - last_count_.value_or(count));
  (steps > 0 ? statistics_.counted_up : statistics_.counted_down) += std::abs(std::int64_t{steps});
  last_count_ = count;
}

std::optional<PlateReading> DeviceLog::take(const PlateReading& reading, std::string_view kind) {
  if (kind.empty()) kind = reading.numbered ? "PPLT" : "lines of an encoder";
  count_telegram(kind);
  if (!is_new(reading.sequence, reading.device_us, reading.receipt_ns, !reading.numbered)) return {};
  note_time(reading.device_us, reading.receipt_ns);
  note_count(reading.count);
  return reading;
}

void DeviceLog::note_repeated(const ColaFrame& frame) {
  const auto telegram = parse_cola(frame.payload, frame.language);
  if (!telegram) return;
  note(telegram->name == kScanDataName && telegram->command == "sSN"
           ? "scans retransmitted by TCP"
           : "other telegrams retransmitted by TCP");
}

}  // namespace crisp
