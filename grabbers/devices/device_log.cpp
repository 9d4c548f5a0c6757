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

}  // namespace crisp

namespace crisp::devices {

DeviceLog::DeviceLog(DeviceKind kind, std::string name, Address address, std::uint16_t laser,
                     clocks::Pauses* pauses)
    : laser_(laser), timeline_(pauses) {
  statistics_.kind = kind;
  statistics_.name = std::move(name);
  statistics_.address = std::move(address);
}

DeviceStatistics DeviceLog::statistics() const {
  auto statistics = statistics_;
  const bool laser = statistics.kind == DeviceKind::Laser;
  timeline_.add_to(statistics, laser ? kTelegramsNeverCame : kReadingsNeverCame);
  statistics.median_handover = handover_.value();
  statistics.period = period_.value();
  return statistics;
}

void DeviceLog::count_telegram(std::string_view kind) {
  constexpr std::size_t kMaxKinds = 256;  // what garbage can cost
  const bool full = statistics_.telegrams.all().size() >= kMaxKinds && statistics_.telegrams.of(kind) == 0;
  statistics_.telegrams.add(full ? "others" : kind);
}

bool DeviceLog::is_new(const DeviceTimeline::Item& item) {
  const auto arrival = timeline_.judge(item);
  if (arrival.begins_anew) last_scan_.reset();  // turns across a reset or a pause give no period
  return arrival.is_new;
}

std::shared_ptr<const Scan> DeviceLog::take(const wire::ColaFrame& frame, EncoderWidths widths) {
  const auto telegram = wire::parse_cola(frame.payload, frame.language);
  if (!telegram) {
    lose("telegrams of an unknown kind");
    return {};
  }
  if (const auto code = wire::cola_error_code(*telegram)) {
    count_telegram(fmt::format("sFA {} ({})", *code, wire::cola_error_text(*code)));
  } else {
    kind_.assign(telegram->command).append(1, ' ').append(telegram->name);
    count_telegram(kind_);
  }
  const bool scan =
      telegram->name == wire::kScanDataName && (telegram->command == "sSN" || telegram->command == "sRA");
  return scan ? take_scan(*telegram, frame.completed_ns, widths) : nullptr;
}

void DeviceLog::lose_scan(std::string_view why) {
  lose(why);
  ++statistics_.unreadable;
}

std::shared_ptr<const Scan> DeviceLog::take_scan(const wire::ColaTelegram& telegram, std::int64_t time_ns,
                                                 EncoderWidths widths) {
  const auto failure = wire::decode_scan_data(telegram, widths, data_);
  if (failure != wire::FieldFailure::None) {
    lose_scan(fmt::format("unreadable scan telegrams: {}", wire::to_string(failure)));
    return {};
  }
  if (data_.appended > 0) note("scan telegrams with unknown fields at their end");
  if (data_.layer != 0) {  // a cone: the rig describes planes
    if (is_new({.counter = data_.telegram_counter,
                .stamp = {.receipt_ns = time_ns, .device_us = data_.transmission_time_us}})) {
      lose("scans of a tilted layer (only the layer at 0 degrees is read)");
    }
    return {};
  }
  auto scan = scans_.get();
  const auto refusal = wire::to_scan(data_, laser_, time_ns, *scan);
  if (refusal != wire::ScanFailure::None) {
    lose_scan(fmt::format("scan telegrams that hold no scan: {}", wire::to_string(refusal)));
    return {};
  }
  const bool polled = telegram.command == "sRA";
  const clocks::DeviceStamp stamp{.receipt_ns = time_ns, .device_us = scan->transmission_time_us};
  if (!is_new({.counter = scan->telegram_counter, .stamp = stamp, .is_polled = polled})) return {};
  if (polled) scan->numbered = false;
  timeline_.pass_on(stamp);
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
  const clocks::DeviceStamp stamp{.receipt_ns = reading.receipt_ns, .device_us = reading.device_us};
  if (!is_new({.counter = reading.sequence, .stamp = stamp, .is_polled = !reading.numbered})) return {};
  timeline_.pass_on(stamp);
  note_count(reading.count);
  return reading;
}

void DeviceLog::note_repeated(const wire::ColaFrame& frame) {
  const auto telegram = wire::parse_cola(frame.payload, frame.language);
  if (!telegram) return;
  note(telegram->name == wire::kScanDataName && telegram->command == "sSN"
           ? "scans retransmitted by TCP"
           : "other telegrams retransmitted by TCP");
}

}  // namespace crisp::devices
