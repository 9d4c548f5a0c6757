// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/plate_unit.hpp"

#include <cmath>

namespace crisp::simulate {
namespace {

constexpr std::size_t kSentenceBytes = 40;  // about

}  // namespace

PlateUnit::PlateUnit(const RecordingSettings& settings, const RecordingTruth& truth, const Motion& motion,
                     double begin)
    : settings_(settings),
      truth_(truth.plate),
      motion_(&motion),
      link_(truth_.link, truth_.minimum_delay, settings.scanner.seed, truth_.name, truth_.latency),
      losses_(settings.scanner.seed, truth_.name + ".losses"),
      begin_(begin),
      time_(begin) {
  check_plate_frequency(settings.scanner);
  sequence_ = static_cast<std::uint16_t>(
      statistics::RandomStream(settings.scanner.seed, truth_.name + ".counters").bits());
}

std::optional<PlateReading> PlateUnit::send() {
  const double read = time_;
  const double period = (1 + truth_.clock.skew) / settings_.scanner.plate_frequency;
  time_ = begin_ + static_cast<double>(++readings_) * period;
  if (const auto restarts = truth_.clock.resets_before(read); restarts != restarts_) {
    restarts_ = restarts;
    sequence_ = 0;
  }
  const double step = settings_.scanner.rig.plate.angle_per_count();
  PlateReading reading;
  reading.sequence = sequence_++;
  reading.device_us = truth_.clock.microseconds(read);
  reading.count = static_cast<std::uint32_t>(std::llround(motion_->at(read)->angle / step));
  const bool lost = losses_.chance(settings_.faults.lost_readings);
  if (lost || settings_.faults.silent(truth_.name, read)) return std::nullopt;
  reading.receipt_ns = settings_.start_ns + std::llround(1e9 * link_.arrival(read, kSentenceBytes));
  return reading;
}

}  // namespace crisp::simulate
