// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_items.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include <crisp/error.hpp>

#include "grabbers/table/append_beams.hpp"
#include "pipeline/data/echoes.hpp"
#include "pipeline/data/mirror_angle.hpp"

namespace crisp::bag {
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
  data::EchoCounts counts;
  const auto used = data::with_used_echoes(scan, rig_.lasers[laser].echo, counts);
  const auto note = [&](const char* what, std::uint64_t n) {
    if (n > 0) losses_[fmt::format("{}: {}", rig_.lasers[laser].name, what)] += n;
  };
  note("beams with a later echo only", counts.later);
  note("echoes that the rig's choice leaves out", counts.unused);
  scans_.push_back(
      {.scan = used, .time = seconds(message.stamp_ns) + rig_.lasers[laser].time_offset, .points = nullptr});
  return scan;
}

std::optional<PlateReading> BagItems::add(const AngleMessage& message, std::int64_t receipt_ns,
                                          double lasts) {
  const std::int64_t stamp_ns = message.stamp_ns.value_or(receipt_ns);
  if (!advance(last_angle_ns_, stamp_ns, "angles that are not later than the one before"))
    return std::nullopt;
  const double reported = message.rotation ? rotation_.angle(*message.rotation) : message.angle;
  const double angle = angles_.unwrap(reported);
  angles_.add(seconds(stamp_ns), angle);
  if (lasts > 0) angles_.add(seconds(stamp_ns) + lasts, angle);
  return PlateReading{.sequence = readings_++,
                      .device_us = clock_bits(device_us(stamp_ns)),
                      .count = angles_.count_at(angle),
                      .receipt_ns = receipt_ns,
                      .numbered = false};
}

Measurements BagItems::beams_of(const std::vector<LaserPoint>& points, double begin) const {
  Measurements beams;
  beams.epoch_ns = *epoch_ns_;
  beams.reserve(points.size());
  for (const auto& [laser, point] : points) {
    const bool on_head = head_.has_value();
    const double reported = on_head ? point.elevation : point.azimuth;
    beams.range.push_back(point.range);
    beams.mirror_angle.push_back(
        static_cast<float>(data::wrapped_mirror_angle(reported - rig_.lasers[laser].mount)));
    beams.time.push_back(begin + point.time);
    beams.laser.push_back(laser);
    beams.remission.push_back(point.remission);
    beams.beam.push_back(on_head ? std::uint16_t{0} : static_cast<std::uint16_t>(beams.beam.size()));
  }
  return beams;
}

bool BagItems::add(const PointMessage& message, std::uint16_t laser) {
  if (!advance(last_scan_ns_[laser], message.stamp_ns, "scans that are not later than the one before"))
    return false;
  if (!message.timed) ++losses_["point clouds without times of the points, which are placed at the stamp"];
  const double begin = seconds(message.stamp_ns) + rig_.lasers[laser].time_offset;
  const auto points = cones_.select(message, std::span(&laser, 1), false);
  scans_.push_back(
      {.scan = nullptr, .time = begin, .points = std::make_shared<Measurements>(beams_of(points, begin))});
  return true;
}

bool BagItems::add_head(const PointMessage& message, std::span<const std::uint16_t> lasers) {
  if (!message.timed) {
    throw Error(fmt::format("the points on {} have no times, and the head turns meanwhile",
                            rig_.lasers[lasers.front()].topic),
                "record the driver's cloud with a field t, time or timestamp");
  }
  if (!advance(last_scan_ns_[lasers.front()], message.stamp_ns,
               "scans that are not later than the one before"))
    return false;
  if (!head_) head_.emplace(*epoch_ns_, max_gap_);
  const double begin = seconds(message.stamp_ns);
  const auto points = cones_.select(message, lasers, true);
  for (const auto& [laser, point] : points) {
    const LaserCalibration& nominal = rig_.lasers[laser].nominal;
    const double from_head = nominal.lambda.value + nominal.alpha.value + std::numbers::pi / 2;
    head_->add_azimuth(begin + point.time, point.azimuth - from_head);
  }
  head_->add(beams_of(points, begin));
  return true;
}

void BagItems::check() const {
  cones_.check();
  constexpr std::uint64_t kFew = 100;
  if (!head_ || head_->contradictions() * kFew <= head_->azimuths()) return;
  throw Error(
      fmt::format("the rings' azimuths contradict one another: {} times in {} azimuths of the head",
                  head_->contradictions(), head_->azimuths()),
      "where rings have azimuths of their own, give each laser's in the rig: nominal: {lambda: 3.2deg, …}");
}

std::map<std::string, std::uint64_t> BagItems::losses() const {
  auto all = losses_;
  for (const auto& [what, n] : cones_.losses()) all[what] += n;
  return all;
}

std::shared_ptr<const Measurements> BagItems::measured(const Stamped& stamped) const {
  if (stamped.points) return stamped.points;
  const Scan& scan = *stamped.scan;
  std::vector<table::BeamEchoes> echoes;
  for (const Echo& echo : scan.echoes) echoes.push_back({echo.ranges, echo.remissions});
  auto beams = std::make_shared<Measurements>();
  beams->epoch_ns = *epoch_ns_;
  table::append_beams({.first_angle = scan.start_angle - rig_.lasers[scan.laser].mount,
                       .angle_step = scan.angle_step,
                       .first_time = stamped.time,
                       .interval = scan.beam_interval,
                       .laser = scan.laser},
                      echoes, *beams);
  return beams;
}

void BagItems::for_each_measured(const std::function<void(std::shared_ptr<const Measurements>)>& use) const {
  for (const Stamped& scan : scans_) {
    if (auto beams = measured(scan); beams->size() > 0) use(std::move(beams));
  }
}

}  // namespace crisp::bag
