// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/item_script.hpp"

#include <cmath>
#include <limits>
#include <random>

namespace crisp {
namespace {

constexpr std::size_t kMaxItems = 1200;
constexpr double kHubBegin = 1'700'000'000.3;  // [s since the Unix epoch]
/// [s] From jumps below the delays to counter wraps; a leap second, TAI against UTC, a wrap of the devices'
/// clocks, and of 32 bits of seconds.
constexpr std::array kJumps = {0.0, 1e-4, 1e-3, 0.02, 0.05,  0.25,   0.5,         1.0,
                               3.0, 6.0,  31.0, 37.0, 600.0, 3600.0, 4294.967296, 86400.0 * 400};

/// A scan of some beams every other of which has an echo, or what a damaged one may hold.
void fill(Scan& scan, std::uint8_t kind, std::size_t beams) {
  scan.scan_frequency = kind % 5 == 1 ? 0 : 25;
  scan.start_angle = -0.78;
  scan.angle_step = kind % 5 == 2 ? 0 : 0.1;
  if (kind % 5 == 3) return;
  scan.echoes.resize(1);
  const float unseen = kind % 5 == 4 ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
  for (std::size_t i = 0; i < beams; ++i) scan.echoes[0].ranges.push_back(i % 2 == 0 ? 2.0F : unseen);
  if (kind >= 128) scan.numbered = false;
}

}  // namespace

double jump_of(std::uint8_t argument) {
  return (argument % 2 == 0 ? 1 : -1) * kJumps[argument / 2 % kJumps.size()];
}

ItemScript::ItemScript(std::span<const std::uint8_t> script) : script_(script) {
  for (std::size_t i = 0; i < devices_.size(); ++i) devices_[i].ahead = 100.0 * static_cast<double>(i);
  devices_[kPlateDevice].every = 1;
}

ItemSequence ItemScript::items() {
  for (std::size_t at = 0; at + 1 < script_.size(); at += 2) {
    operate(script_[at] & 0xFU, script_[at] >> 4U & 3U, script_[at + 1]);
  }
  return std::move(items_);
}

void ItemScript::operate(unsigned operation, std::size_t index, std::uint8_t argument) {
  Device& device = devices_[index];
  switch (operation) {
    case 0:
      return send_for(0.02 * (argument + 1));
    case 1:
      speaking_ = argument;
      return;
    case 2:
      hub_ahead_ += jump_of(argument);
      return;
    case 3:
      device.ahead += jump_of(argument);
      return;
    case 4:
      device.stands = argument % 2 == 1;
      device.stood_at = now_ + device.ahead;
      return;
    case 5:
      device.count = static_cast<std::uint16_t>(device.count + argument);
      return;
    case 6:
      device.step = 1e-6 * (1 + argument * argument);
      return;
    case 7:
      hub_rate_ = 50e-6 * (argument - 128);
      return;
    case 8:
      device.delay += 1e-3 * argument;
      return;
    case 9:
      device.off += jump_of(argument);
      return;
    case 10:
      device.kind = argument;
      return;
    case 11:
      encoder_ahead_ += argument * argument;
      return;
    case 12:
      return send_odd(index, argument);
    case 13:
      device.copies = argument % 4;
      return;
    case 14:
      device.every = 1U + argument % 50U;
      return;
    default:
      device.beams = 1U + argument % 48U;
  }
}

/// 25 scans a second of each laser, and 100 readings, by default.
void ItemScript::send_for(double seconds) {
  constexpr double kInterval = 0.01;
  const int n = static_cast<int>(std::lround(seconds / kInterval));
  for (int i = 0; i < n && items_.size() < kMaxItems; ++i) {
    now_ += kInterval;
    hub_ahead_ += hub_rate_ * kInterval;
    for (std::size_t device = 0; device < devices_.size(); ++device) {
      const std::size_t every = devices_[device].every;
      const bool is_due = static_cast<std::size_t>(i) % every == device % every;
      if (is_due && (speaking_ >> device & 1U) != 0) send(device, now_);
    }
  }
}

std::uint32_t ItemScript::stamp(Device& device, double now) const {
  const double shown = device.stands ? device.stood_at : now + device.ahead;
  const double us = std::floor(shown / device.step) * device.step * 1e6;
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(us));
}

std::int64_t ItemScript::receipt_ns(const Device& device, double now) const {
  return std::llround(1e9 * (kHubBegin + now + device.delay + device.off + hub_ahead_));
}

void ItemScript::send(std::size_t index, double now) {
  Device& device = devices_[index];
  ++device.count;
  for (unsigned copy = 0; copy < device.copies; ++copy) {
    if (index == kPlateDevice) {
      PlateReading reading;
      reading.sequence = device.count;
      reading.device_us = stamp(device, now);
      reading.count = static_cast<std::uint32_t>(std::lround(16384 * now)) + encoder_ahead_;
      reading.receipt_ns = receipt_ns(device, now);
      items_.emplace_back(reading);
      continue;
    }
    Scan scan;
    scan.laser = static_cast<std::uint16_t>(index);
    scan.telegram_counter = scan.scan_counter = device.count;
    scan.scan_time_us = stamp(device, now - 0.04);
    scan.transmission_time_us = stamp(device, now);
    scan.receipt_ns = receipt_ns(device, now);
    fill(scan, device.kind, device.beams);
    items_.emplace_back(std::make_shared<const Scan>(std::move(scan)));
  }
}

void ItemScript::send_odd(std::size_t index, std::uint8_t seed) {
  std::minstd_rand random(seed + 1U);
  const auto bits = [&] { return static_cast<std::uint32_t>(random() * 2654435761U); };
  const std::int64_t receipt = receipt_ns(devices_[index], now_);
  if (index == kPlateDevice) {
    PlateReading reading;
    reading.sequence = static_cast<std::uint16_t>(bits());
    reading.device_us = bits();
    reading.count = bits();
    reading.receipt_ns = receipt;
    items_.emplace_back(reading);
    return;
  }
  Scan scan;
  scan.laser = static_cast<std::uint16_t>(seed % 3 == 0 ? bits() : index);
  scan.scan_counter = static_cast<std::uint16_t>(bits());
  scan.scan_time_us = bits();
  scan.transmission_time_us = seed % 2 == 0 ? scan.scan_time_us + 25'000 : bits();
  scan.receipt_ns = receipt;
  fill(scan, seed, devices_[index].beams);
  items_.emplace_back(std::make_shared<const Scan>(std::move(scan)));
}

}  // namespace crisp
