// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/scan_timestamper.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace crisp::clock {
namespace {

constexpr std::int64_t kNewRun = 1'000'000;  // turns: after a reset, nothing is a neighbour
constexpr std::size_t kNeighbours = 10;      // as many as a mirror is ever smoothed over
constexpr double kLongestHandover = 1;       // [s] from a scan's stamp to its transmission
constexpr double kEarliestHandover = -0.1;   // [s]
constexpr double kMinHandover = 0.75;        // of a turn: a full sweep of 270°
constexpr double kAhead = 0.5;               // [s] how far a stamp's jitter may hide that it is due

double seconds(std::int64_t us) { return 1e-6 * static_cast<double>(us); }

}  // namespace

bool ScanTimestamper::add(std::shared_ptr<const Scan> scan, double hub) {
  if (scan->echoes.empty() || scan->echoes.front().ranges.empty()) {
    ++without_ranges_;
    return false;
  }
  scan = data::with_used_echoes(std::move(scan), laser_.echo, echoes_);
  const auto handover_us = static_cast<std::int32_t>(scan->transmission_time_us - scan->scan_time_us);
  const double handover = seconds(handover_us);
  if (handover < kEarliestHandover || handover > kLongestHandover) {
    stamps_.count_damaged();
    return false;
  }
  if (nominal_period_ == 0 && scan->scan_frequency > 0) {
    nominal_period_ = 1 / scan->scan_frequency;
    stamps_.set_period(nominal_period_);
  }
  stamps_.trust_counter(scan->numbered);
  const auto arrival =
      stamps_.accept(scan->scan_counter, scan->transmission_time_us, scan->receipt_ns, hub, handover_us);
  if (arrival.kind == clocks::StampKind::repeated) return false;
  if (arrival.kind == clocks::StampKind::returned && !pending_.empty()) pending_.pop_back();
  turn_ += arrival.kind == clocks::StampKind::next ? arrival.steps : kNewRun;
  handovers_.add(handover);
  pending_.push_back({.scan = std::move(scan),
                      .stamp = {.turn = turn_, .time = seconds(arrival.device_us - handover_us)},
                      .stamp_receipt = hub - handover});
  return true;
}

void ScanTimestamper::count_beams(const Scan& scan, const Measurements& measurements) {
  const auto& all = measurements.beam;
  std::size_t came_back = all.size();
  if (scan.echoes.size() > 1) {  // of a beam as many as came back
    for (std::size_t i = 1; i < all.size(); ++i) came_back -= all[i] == all[i - 1] ? 1 : 0;
  }
  beams_ += scan.echoes.front().ranges.size();
  without_echo_ += scan.echoes.front().ranges.size() - came_back;
}

double ScanTimestamper::base(const Pending& scan, double device_time) const {
  if (source_ == TimeSource::receipt) return scan.stamp_receipt;
  return stamps_.map()->to_hub(device_time);
}

std::size_t ScanTimestamper::count_before(double limit) const {
  std::size_t n = 0;
  while (n < pending_.size() && base(pending_[n], pending_[n].stamp.time) < limit) ++n;
  return n;
}

void ScanTimestamper::take_before(double limit, std::vector<TimedScan>& out) {
  if (!stamps_.map()) return;
  const std::size_t due = count_before(limit + kAhead);
  const std::size_t seen = std::min(due + kNeighbours, pending_.size());
  std::vector<MirrorStamp> stamps = taken_;
  for (std::size_t i = 0; i < seen; ++i) stamps.push_back(pending_[i].stamp);
  const auto turns = smooth_mirror(stamps, {.half_width = half_width_, .nominal_period = nominal_period_});

  std::size_t n = 0;
  for (; n < due; ++n) {
    const MirrorTurn& turn = turns[taken_.size() + n];
    const double hub = base(pending_[n], turn.time);
    const double period = stamps_.map()->to_hub(turn.time + turn.period) - stamps_.map()->to_hub(turn.time);
    const double begin = hub + laser_.time_offset + laser_.period_offset * period;
    if (begin >= limit) break;
    out.push_back({.scan = std::move(pending_[n].scan), .begin = begin, .period = period});
  }
  stamps.resize(taken_.size() + n);
  stamps.erase(stamps.begin(),
               stamps.end() - static_cast<std::ptrdiff_t>(std::min(stamps.size(), kNeighbours)));
  taken_ = std::move(stamps);
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(n));
}

std::string ScanTimestamper::stamp_warning() const {
  const DeviceReport report = stamps_.report();
  if (report.by_receipt || 2 * report.standing > report.received) return {};  // stamps that never move
  const double handover = handovers_.quantile(0.5);
  const double period = stamps_.period();
  if (laser_.period_offset != 0 || period <= 0 || handover >= kMinHandover * period) return {};
  return fmt::format(
      "{}: its scans leave {:.1f} ms after their stamps, but a full sweep takes {:.1f} ms: the stamps are late by whole turns of the mirror; set period_offset: -1 for {} in the rig",
      laser_.name, 1e3 * handover, 1e3 * kMinHandover * period, laser_.name);
}

}  // namespace crisp::clock
