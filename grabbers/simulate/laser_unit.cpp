// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/laser_unit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

#include "grabbers/wire/scan_conversion.hpp"

namespace crisp::simulate {
namespace {

constexpr double kTenThousandths = 1e4 * 180 / std::numbers::pi;  // [1/rad] angles on the wire: 1/10000°
constexpr double kMillimetres = 1e3;                              // [1/m] ranges on the wire
constexpr double kFarthest = 65;                                  // [m] in 16 bits of millimetres
constexpr std::uint32_t kFirstSerialNumber = 18090001;
constexpr double kRounding = 1e-9;         // [rad] that an angle may be off on the wire
constexpr std::size_t kHeaderBytes = 110;  // approximate size of a telegram without its values

void check_unit(const ScannerSettings& settings, const FieldOfView& field) {
  if (settings.range.max_distance > kFarthest) {
    throw Error("a laser's telegrams cannot hold ranges beyond 65 m", "lower the largest distance");
  }
  if (!settings.beams.empty()) {
    throw Error("a telegram holds all beams of the field of view, not selected ones",
                "narrow the field of view instead");
  }
  const auto step = static_cast<std::uint16_t>(std::lround(field.step * kTenThousandths));
  const double first = std::round(field.first * kTenThousandths) / kTenThousandths;
  if (std::abs(wire::exact_angle_step(step) - field.step) > kRounding ||
      std::abs(first - field.first) > kRounding) {
    throw Error("a laser's telegrams cannot hold the angles of this field of view",
                "use whole 1/10000° or fractions like 1/3°");
  }
}

wire::ChannelBlock channel(const char* name, const FieldOfView& field, std::size_t values) {
  wire::ChannelBlock block;
  block.name = name;
  block.start_angle = static_cast<std::int32_t>(std::lround(field.first * kTenThousandths));
  block.angle_step = static_cast<std::uint16_t>(std::lround(field.step * kTenThousandths));
  block.raw.reserve(values);
  return block;
}

std::int64_t to_ns(std::int64_t start_ns, double seconds) { return start_ns + std::llround(seconds * 1e9); }

}  // namespace

LaserUnit::LaserUnit(const RecordingSettings& settings, const RecordingTruth& truth, std::uint16_t index)
    : settings_(settings),
      truth_(truth.lasers[index]),
      rig_(settings.scanner.rig.lasers[index]),
      pattern_(settings.scanner.pattern_of(index)),
      index_(index),
      link_(truth_.link, truth_.minimum_delay, settings.scanner.seed, rig_.name, truth_.latency),
      handover_(settings.scanner.seed, rig_.name + ".handover"),
      losses_(settings.scanner.seed, rig_.name + ".losses") {
  check_unit(settings.scanner, pattern_.field);
  statistics::RandomStream random(settings.scanner.seed, rig_.name + ".counters");
  scan_counter_ = static_cast<std::uint16_t>(random.bits());
  counter_difference_ = static_cast<std::uint16_t>(random.bits() % 512);
}

std::optional<LaserTelegram> LaserUnit::send(const Sweep& sweep) {
  const double jitter = settings_.telegrams.handover_jitter * handover_.normal();
  const double handover = std::max(0.0, settings_.telegrams.handover + jitter);
  const double seen = std::max(sweep.revolution.begin + sweep.revolution.period, sweep.times.back());
  const double sent = seen + handover;
  LaserTelegram telegram{.laser = index_};
  fill_header(telegram.data, sweep, sent);
  fill_channels(telegram.data, sweep);
  const bool lost = losses_.chance(settings_.faults.lost_scans);
  const auto& clock = truth_.clock;
  const bool cut = clock.resets_before(sweep.revolution.begin) != clock.resets_before(sent);
  if (lost || cut || settings_.faults.silent(rig_.name, sent)) return std::nullopt;
  const std::size_t bytes = kHeaderBytes + 3 * sweep.beams.size();
  telegram.receipt_ns = to_ns(settings_.start_ns, link_.arrival(sent, bytes));
  return telegram;
}

/// The rig defines the offset of the device's stamp from the first possible beam: inverts exactly that.
double LaserUnit::stamp_of(const Sweep& sweep) const {
  return sweep.revolution.begin - rig_.period_offset * sweep.revolution.period - rig_.time_offset +
         truth_.stamp_lag;
}

void LaserUnit::fill_header(wire::ScanData& data, const Sweep& sweep, double sent) {
  if (const auto restarts = truth_.clock.resets_before(sent); restarts != restarts_) {
    restarts_ = restarts;
    scan_counter_ = 0;
    scans_since_start_ = 0;
  }
  data.serial_number = kFirstSerialNumber + index_;
  data.device_status = scans_since_start_++ < settings_.telegrams.settling_scans ? 1 : 0;
  data.scan_counter = scan_counter_++;
  data.telegram_counter = static_cast<std::uint16_t>(data.scan_counter + counter_difference_);
  data.scan_time_us = truth_.clock.microseconds(stamp_of(sweep));
  data.transmission_time_us = truth_.clock.microseconds(sent);
  data.scan_frequency = static_cast<std::uint32_t>(std::lround(pattern_.frequency * 100));
  const double beams_a_turn = 2 * std::numbers::pi / pattern_.field.step;
  data.measurement_frequency =
      static_cast<std::uint32_t>(std::lround(pattern_.frequency * beams_a_turn / 100));
}

void LaserUnit::fill_channels(wire::ScanData& data, const Sweep& sweep) const {
  wire::ChannelBlock distances = channel("DIST1", pattern_.field, sweep.ranges.size());
  for (const float range : sweep.ranges) {
    distances.raw.push_back(static_cast<std::uint16_t>(std::lround(range * kMillimetres)));
  }
  data.channels16.push_back(std::move(distances));
  if (settings_.telegrams.remission == RemissionChannel::none) return;
  wire::ChannelBlock remissions = channel("RSSI1", pattern_.field, sweep.remissions.size());
  for (const float remission : sweep.remissions) {
    remissions.raw.push_back(static_cast<std::uint16_t>(remission));
  }
  const bool wide = settings_.telegrams.remission == RemissionChannel::bits16;
  (wide ? data.channels16 : data.channels8).push_back(std::move(remissions));
}

}  // namespace crisp::simulate
