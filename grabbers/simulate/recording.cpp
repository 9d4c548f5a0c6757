// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/recording.hpp"

#include <algorithm>
#include <cmath>

#include "grabbers/wire/scan_conversion.hpp"
#include "pipeline/data/internal_error.hpp"

namespace crisp::simulate {
namespace {

constexpr double kPlateMargin = 0.1;  // [s] of readings before the first and after the last sweep

}  // namespace

std::int64_t receipt_ns(const HubEvent& event) {
  return std::visit([](const auto& received) { return received.receipt_ns; }, event);
}

RecordingSimulator::RecordingSimulator(const RecordingSettings& settings, const Scene& scene,
                                       const TermRegistry& terms)
    : settings_(settings),
      truth_(draw_devices(settings)),
      motion_(make_motion(settings.scanner.motion, settings.scanner.duration, settings.scanner.seed)),
      sweeps_(settings.scanner, scene, motion_, terms),
      plate_(settings, truth_, motion_, -kPlateMargin) {
  for (std::size_t i = 0; i < truth_.lasers.size(); ++i) {
    lasers_.emplace_back(settings, truth_, static_cast<std::uint16_t>(i));
  }
  upcoming_ = sweeps_.next();
  now_ = plate_.next_time();
}

std::optional<HubEvent> RecordingSimulator::next() {
  const auto since_start = [&](std::int64_t ns) {
    return static_cast<double>(ns - settings_.start_ns) * 1e-9;
  };
  while (in_flight_.empty() || since_start(in_flight_.first_ns()) >= now_) {
    if (!fire()) break;
  }
  auto event = in_flight_.pop();
  if (!event) return std::nullopt;
  return std::move(event->item);
}

/// The count is as old as a reading with the plate's least delay would be, so that η is that of the truth.
PlateReading RecordingSimulator::count_into(LaserTelegram& telegram) const {
  const double latched = lasers_[telegram.laser].stamp_of(upcoming_) +
                         truth_.lasers[telegram.laser].minimum_delay - truth_.plate.minimum_delay;
  const double angle = motion_.at(latched).value_or(PlateState{}).angle;
  const double step = settings_.scanner.rig.plate.angle_per_count();
  wire::ScanData& data = telegram.data;
  data.encoders = {{.position = static_cast<std::uint32_t>(std::llround(angle / step))}};
  return {.sequence = data.telegram_counter,
          .device_us = data.scan_time_us,
          .count = data.encoders.front().position,
          .receipt_ns = telegram.receipt_ns,
          .handover_us = static_cast<std::int32_t>(data.transmission_time_us - data.scan_time_us)};
}

bool RecordingSimulator::fire() {
  const auto encoder_of = settings_.scanner.rig.plate.encoder_of;
  const double sweep = upcoming_.revolution.begin;
  const double end = settings_.scanner.duration;
  if (sweep >= end && plate_.next_time() > end + kPlateMargin) return false;
  if (sweep < end && sweep <= plate_.next_time()) {
    if (auto telegram = lasers_[upcoming_.laser].send(upcoming_)) {
      if (encoder_of == upcoming_.laser) hold(count_into(*telegram));
      hold(std::move(*telegram));
    }
    upcoming_ = sweeps_.next();
  } else if (const auto reading = plate_.send(); reading && !encoder_of) {
    hold(*reading);
  }
  now_ = std::min(upcoming_.revolution.begin, plate_.next_time());
  return true;
}

void RecordingSimulator::hold(HubEvent event) {
  const auto received_ns = receipt_ns(event);
  in_flight_.push(received_ns, std::move(event));
}

double RecordingSimulator::progress() const {
  return std::clamp(now_ / settings_.scanner.duration, 0.0, 1.0);
}

Scan to_scan(const LaserTelegram& telegram) {
  Scan scan;
  const auto failure = to_scan(telegram.data, telegram.laser, telegram.receipt_ns, scan);
  if (failure != wire::ScanFailure::None) {
    throw data::internal_error("the simulator made a telegram that holds no scan: " +
                               std::string(wire::to_string(failure)));
  }
  return scan;
}

SimulatedRecording simulate_recording(const RecordingSettings& settings, const Scene& scene,
                                      const TermRegistry& terms) {
  RecordingSimulator simulator(settings, scene, terms);
  SimulatedRecording recording{.scans = {}, .readings = {}, .truth = simulator.truth()};
  while (const auto event = simulator.next()) {
    if (const auto* telegram = std::get_if<LaserTelegram>(&*event)) {
      recording.scans.push_back(to_scan(*telegram));
    } else {
      recording.readings.push_back(std::get<PlateReading>(*event));
    }
  }
  return recording;
}

}  // namespace crisp::simulate
