// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/table_items.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "grabbers/table/append_beams.hpp"

namespace crisp::table {
namespace {

constexpr double kMicro = 1e6, kNano = 1e9;
constexpr std::int64_t kMicrosecond = 1000;      // [ns]
constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]

/// The device's 32 bits of microseconds.
std::uint32_t wrapped_us(std::int64_t us) { return static_cast<std::uint32_t>(us); }

std::int64_t microseconds(double s) { return std::llround(s * kMicro); }

}  // namespace

TableItems::TableItems(const TableFormat& format, const TableScanSettings& settings, Rig rig)
    : format_(format), settings_(settings), rig_(std::move(rig)), angles_(rig_.plate) {
  ends_.assign(rig_.lasers.size(), -std::numeric_limits<double>::infinity());
}

std::optional<std::int64_t> TableItems::turn_of(const TableRow& row) const {
  if (!row.counter) return turn_ + 1;
  if (!last_counter_) return 0;
  const std::int64_t modulus = format_.counter_modulus;
  const std::int64_t on = (((*row.counter - *last_counter_) % modulus) + modulus) % modulus;
  if (on == 0) return {};
  return turn_ + on;
}

std::int64_t TableItems::time_of(const TableRow& row, std::int64_t turn) const {
  if (row.time_ns) return *row.time_ns;
  if (row.receipt_ns) return *row.receipt_ns;
  return std::llround(static_cast<double>(turn) * format_.period * kNano);
}

double TableItems::seconds(std::int64_t ns) const { return static_cast<double>(ns - epoch_ns_) / kNano; }

std::shared_ptr<const Scan> TableItems::scan_of(const TableRow& row, std::int64_t time_ns) const {
  auto scan = std::make_shared<Scan>();
  scan->laser = row.laser;
  scan->serial_number = row.laser;
  scan->telegram_counter = scan->scan_counter = static_cast<std::uint16_t>(turn_);
  scan->numbered = row.counter.has_value();
  scan->timed = !row.counter && row.time_ns;
  const std::int64_t stamp_us = row.counter ? microseconds(static_cast<double>(turn_) * format_.period)
                                            : (time_ns - epoch_ns_) / kMicrosecond;
  scan->scan_time_us = wrapped_us(stamp_us);
  scan->transmission_time_us = wrapped_us(stamp_us + microseconds(format_.period));
  scan->receipt_ns = row.receipt_ns.value_or(time_ns);
  scan->scan_frequency = format_.period > 0 ? 1 / format_.period : 0;
  scan->start_angle = settings_.start_angle;
  scan->angle_step = settings_.angle_step;
  if (format_.range_column) scan->echoes.push_back({.ranges = row.ranges, .remissions = row.remissions});
  return scan;
}

void TableItems::add_beams(const TableRow& row, double time) {
  const bool single = format_.mirror_column.has_value();
  constexpr std::size_t kTogether = 4096;  // single beams in one item
  if (!single || beams_.empty() || beams_.back()->size() >= kTogether) {
    beams_.push_back(std::make_shared<Measurements>());
    beams_.back()->epoch_ns = epoch_ns_;
  }
  Measurements& beams = *beams_.back();
  const double first = (single ? row.mirror : settings_.start_angle) - rig_.lasers[row.laser].mount;
  const std::size_t before = beams.size();
  const BeamEchoes echo{.ranges = row.ranges, .remissions = row.remissions};
  append_beams({.first_angle = first,
                .angle_step = settings_.angle_step,
                .first_time = time,
                .interval = settings_.beam_interval,
                .laser = row.laser},
               {&echo, 1}, beams);
  beam_count_ += beams.size() - before;
}

/// An angle may begin anew at a whole turn, and its step be up to half a turn more or less than that.
void TableItems::note_step(double reported) {
  constexpr double kTurnAndAHalf = 3 * std::numbers::pi;
  large_steps_ += last_reported_ && std::abs(reported - *last_reported_) >= kTurnAndAHalf ? 1 : 0;
  last_reported_ = reported;
}

void TableItems::note_end(const TableRow& row, double time) {
  if (row.ranges.empty() || !row.time_ns) return;  // receipts come in bursts
  const double lasts = static_cast<double>(row.ranges.size() - 1) * settings_.beam_interval;
  overlapping_ += time < ends_[row.laser];
  ends_[row.laser] = time + lasts;
}

std::optional<std::int64_t> TableItems::admit(const TableRow& row) {
  if (row.laser >= rig_.lasers.size()) {
    ++losses_["rows of a laser that the rig does not have"];
    return {};
  }
  const auto turn = turn_of(row);
  if (!turn) {
    ++losses_["rows with the counter of the row before"];
    return {};
  }
  const std::int64_t time_ns = time_of(row, *turn);
  if (last_ns_ && time_ns < *last_ns_) {
    ++losses_["rows that are earlier than the row before"];
    if (first_early_line_ == 0) first_early_line_ = row.line;
    return {};
  }
  last_ns_ = time_ns;
  turn_ = *turn;
  if (row.counter) last_counter_ = row.counter;
  return time_ns;
}

std::optional<TableScan> TableItems::add(const TableRow& row) {
  const auto time_ns = admit(row);
  return time_ns ? std::optional(add(row, *time_ns)) : std::nullopt;
}

TableScan TableItems::add(const TableRow& row, std::int64_t time_ns) {
  if (rows_ == 0) epoch_ns_ = time_ns - time_ns % kSecond;
  const double time = seconds(time_ns);
  note_step(row.angle);
  const double angle = angles_.unwrap(row.angle);
  const bool stands = settings_.actuator == ActuatorMotion::stands;
  const double lasts = static_cast<double>(row.ranges.size()) * settings_.beam_interval;
  angles_.add(time, angle);
  if (stands) angles_.add(time + lasts, angle);
  note_end(row, time);
  add_beams(row, time);

  TableScan item;
  if (format_.angle_column && (!last_reading_us_ || time_ns / kMicrosecond > *last_reading_us_)) {
    last_reading_us_ = time_ns / kMicrosecond;
    item.reading = PlateReading{.sequence = readings_++,
                                .device_us = wrapped_us((time_ns - epoch_ns_) / kMicrosecond),
                                .count = angles_.count_at(angle),
                                .receipt_ns = time_ns,
                                .numbered = false};
  }
  if (!format_.mirror_column) item.scan = scan_of(row, time_ns);
  ++rows_;
  return item;
}

PlateTrajectory TableItems::trajectory() const { return angles_.trajectory(epoch_ns_, settings_.max_gap); }

std::vector<std::shared_ptr<const Measurements>> TableItems::take_measurements() {
  return take_measurements_until(std::numeric_limits<double>::infinity());
}

std::vector<std::shared_ptr<const Measurements>> TableItems::take_measurements_until(double time) {
  const auto first_left = std::ranges::find_if(
      beams_, [&](const auto& beams) { return beams->size() > 0 && beams->time.back() > time; });
  std::vector<std::shared_ptr<const Measurements>> all;
  for (auto it = beams_.begin(); it != first_left; ++it) {
    forgotten_ += (*it)->size();
    if ((*it)->size() > 0) all.push_back(std::move(*it));
  }
  beams_.erase(beams_.begin(), first_left);
  return all;
}

double TableItems::middle_time() const {
  const auto is_empty = [](const auto& beams) { return beams->size() == 0; };
  const auto middle =
      std::ranges::find_if_not(beams_.begin() + std::ssize(beams_) / 2, beams_.end(), is_empty);
  return middle == beams_.end() ? std::numeric_limits<double>::infinity() : (*middle)->time.back();
}

void TableItems::forget_angles_before(double time) { angles_.forget_before(time); }

}  // namespace crisp::table
