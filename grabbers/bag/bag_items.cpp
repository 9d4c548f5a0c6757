// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_items.hpp"

#include <cmath>
#include <utility>

#include "grabbers/table/append_beams.hpp"

namespace crisp {
namespace {

constexpr std::int64_t kNsInUs = 1000;
constexpr std::int64_t kNsInSecond = 1'000'000'000;

/// The 32 bits that a device's clock has.
std::uint32_t clock_bits(std::int64_t us) { return static_cast<std::uint32_t>(us); }

/// [s] from the first beam to the next scan's: by the message, or else until all its beams were fired.
double duration_of(const ScanMessage& message) {
  return message.scan_time > 0 ? message.scan_time : duration_of_beams(message);
}

}  // namespace

double duration_of_beams(const ScanMessage& message) {
  const std::size_t beams = message.echoes.empty() ? 0 : message.echoes.front().ranges.size();
  return std::abs(message.time_increment) * static_cast<double>(beams);
}

bool BagItems::advance(std::optional<std::int64_t>& last, std::int64_t stamp_ns, const char* what) {
  if (last && stamp_ns <= *last) {
    ++losses_[what];
    return false;
  }
  last = stamp_ns;
  if (!epoch_ns_) epoch_ns_ = stamp_ns - stamp_ns % kNsInSecond;
  return true;
}

std::int64_t BagItems::device_us(std::int64_t stamp_ns) const { return (stamp_ns - *epoch_ns_) / kNsInUs; }

double BagItems::seconds(std::int64_t stamp_ns) const {
  return static_cast<double>(stamp_ns - *epoch_ns_) / static_cast<double>(kNsInSecond);
}

std::shared_ptr<const Scan> BagItems::add(ScanMessage message, std::int64_t receipt_ns, std::uint16_t laser) {
  if (!advance(last_scan_ns_[laser], message.stamp_ns, "scans that are not later than the one before"))
    return nullptr;
  auto scan = std::make_shared<Scan>();
  const double lasts = duration_of(message);
  scan->laser = laser;
  scan->serial_number = laser;
  scan->telegram_counter = scan->scan_counter = counters_[laser]++;
  scan->numbered = false;
  const std::int64_t stamp_us = device_us(message.stamp_ns);
  scan->scan_time_us = clock_bits(stamp_us);
  scan->transmission_time_us = clock_bits(stamp_us + std::llround(lasts * 1e6));
  scan->receipt_ns = receipt_ns;
  scan->scan_frequency = lasts > 0 ? 1 / lasts : 0;
  scan->start_angle = message.angle_min;
  scan->angle_step = message.angle_increment;
  scan->timing = BeamTiming::stated;
  scan->beam_interval = message.time_increment;
  scan->echoes = std::move(message.echoes);
  scans_.push_back({scan, seconds(message.stamp_ns) + rig_.lasers[laser].time_offset});
  return scan;
}

std::optional<PlateReading> BagItems::add(const AngleMessage& message, std::int64_t receipt_ns,
                                          double lasts) {
  const std::int64_t stamp_ns = message.stamp_ns.value_or(receipt_ns);
  if (!advance(last_angle_ns_, stamp_ns, "angles that are not later than the one before"))
    return std::nullopt;
  const double angle = angles_.unwrap(message.angle);
  angles_.add(seconds(stamp_ns), angle);
  if (lasts > 0) angles_.add(seconds(stamp_ns) + lasts, angle);
  return PlateReading{.sequence = readings_++,
                      .device_us = clock_bits(device_us(stamp_ns)),
                      .count = angles_.count_at(angle),
                      .receipt_ns = receipt_ns,
                      .numbered = false};
}

void BagItems::for_each_measured(const std::function<void(std::shared_ptr<const Measurements>)>& use) const {
  for (const auto& [scan, time] : scans_) {
    if (scan->echoes.empty()) continue;
    auto beams = std::make_shared<Measurements>();
    beams->epoch_ns = *epoch_ns_;
    append_beams({.first_angle = scan->start_angle - rig_.lasers[scan->laser].mount,
                  .angle_step = scan->angle_step,
                  .first_time = time,
                  .interval = scan->beam_interval,
                  .laser = scan->laser},
                 scan->echoes.front().ranges, scan->echoes.front().remissions, *beams);
    if (beams->size() > 0) use(std::move(beams));
  }
}

}  // namespace crisp
