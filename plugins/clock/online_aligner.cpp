// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <utility>

#include <crisp/clock_aligner.hpp>

#include "plugins/clock/hub_timings.hpp"

namespace crisp {
namespace {

using clock::TimedScan;

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kFuture = 1;        // [s] a scan that claims to be younger is not waited for
constexpr double kReadingsKept = 2;  // [s] longer than any scan waits and reaches back

double last_beam(const TimedScan& scan) {
  const std::size_t beams = scan.scan->echoes.front().ranges.size();
  return scan.beam_time(beams > 0 ? beams - 1 : 0);
}

}  // namespace

OnlineSettings with_lags(OnlineSettings settings, const Calibration& calibration) {
  if (calibration.lasers.empty()) return settings;
  const auto lag = [](const LaserCalibration& laser) { return laser.eta.value; };
  settings.least_lag = lag(*std::ranges::min_element(calibration.lasers, {}, lag));
  settings.greatest_lag = lag(*std::ranges::max_element(calibration.lasers, {}, lag)) + settings.lag_margin;
  return settings;
}

class OnlineAligner::Queue {
 public:
  Queue(const Rig& rig, const AlignmentSettings& alignment, const OnlineSettings& online, AlignmentSink sink);

  void add(std::shared_ptr<const Scan> scan);
  void add(const PlateReading& reading);
  AlignmentReport finish();
  void set_lags(const Calibration& calibration) { settings_ = with_lags(settings_, calibration); }
  const clock::HubTimings& tracks() const { return tracks_; }
  std::size_t waiting() const { return waiting_.size(); }

 private:
  bool is_covered(const TimedScan& scan) const;
  void hand_out(const TimedScan& scan);
  void release();

  AlignmentSettings alignment_;
  OnlineSettings settings_;
  AlignmentSink sink_;
  clock::HubTimings tracks_;
  std::deque<TimedScan> waiting_;
  std::uint64_t impatient_ = 0;  ///< scans that went without the encoder readings
};

OnlineAligner::Queue::Queue(const Rig& rig, const AlignmentSettings& alignment, const OnlineSettings& online,
                            AlignmentSink sink)
    : alignment_(alignment), settings_(online), sink_(std::move(sink)), tracks_(rig, alignment) {}

void OnlineAligner::Queue::add(std::shared_ptr<const Scan> scan) {
  const double hub = tracks_.arrive(scan->receipt_ns);
  clock::ScanTimestamper* laser = tracks_.track_of(*scan);
  if (laser == nullptr) return;
  if (!laser->add(std::move(scan), hub)) return;
  laser->clock().follow(settings_.window);
  if (laser->clock().followed() >= settings_.warm_up) {
    std::vector<TimedScan> timed;
    laser->take_before(kForever, timed);
    for (auto& one : timed) waiting_.push_back(std::move(one));
  }
  release();
}

void OnlineAligner::Queue::add(const PlateReading& reading) {
  const double hub = tracks_.arrive(reading.receipt_ns);
  clock::EncoderTimestamper& plate = tracks_.plate();
  if (plate.add(reading, hub)) plate.clock().follow(settings_.window);
  plate.forget_before(hub - kReadingsKept);
  release();
}

bool OnlineAligner::Queue::is_covered(const TimedScan& scan) const {
  const clock::EncoderTimestamper& plate = tracks_.plate();
  if (plate.clock().followed() < settings_.warm_up) return false;
  const auto latest = plate.latest();
  return latest && *latest >= last_beam(scan) + settings_.greatest_lag;
}

void OnlineAligner::Queue::release() {
  while (!waiting_.empty()) {
    const TimedScan& scan = waiting_.front();
    const bool covered = is_covered(scan);
    const double longest = settings_.plate_timeout + settings_.warm_up + settings_.greatest_lag;
    const double waited = tracks_.now() - last_beam(scan);
    if (!covered && waited < longest && waited > -kFuture) return;
    if (!covered) ++impatient_;
    hand_out(scan);
    waiting_.pop_front();
  }
}

void OnlineAligner::Queue::hand_out(const TimedScan& scan) {
  sink_.trajectory(tracks_.plate().piece(scan.begin + settings_.least_lag - settings_.margin,
                                         last_beam(scan) + settings_.greatest_lag + settings_.margin,
                                         tracks_.epoch_ns(), alignment_.plate));
  sink_.measurements(tracks_.measurements_of(scan));
}

AlignmentReport OnlineAligner::Queue::finish() {
  tracks_.refuse_if_missing();
  std::vector<TimedScan> young;  // of clocks that were not warm yet
  for (auto& laser : tracks_.lasers()) laser.take_before(kForever, young);
  for (auto& one : young) waiting_.push_back(std::move(one));
  for (const auto& scan : std::exchange(waiting_, {})) hand_out(scan);
  tracks_.finish_clocks();
  AlignmentReport report = tracks_.report();
  report.counts["scans passed on without encoder readings (timeout)"] = impatient_;
  return report;
}

OnlineAligner::OnlineAligner(const Rig& rig, const AlignmentSettings& alignment, const OnlineSettings& online,
                             AlignmentSink sink)
    : queue_(std::make_unique<Queue>(rig, alignment, online, std::move(sink))) {}

OnlineAligner::~OnlineAligner() = default;

void OnlineAligner::add(std::shared_ptr<const Scan> scan) { queue_->add(std::move(scan)); }

void OnlineAligner::add(const PlateReading& reading) { queue_->add(reading); }

AlignmentReport OnlineAligner::finish() { return queue_->finish(); }

void OnlineAligner::set_lags(const Calibration& calibration) { queue_->set_lags(calibration); }

std::vector<DeviceReport> OnlineAligner::devices() const { return queue_->tracks().reports(); }

double OnlineAligner::now() const { return queue_->tracks().now(); }

std::size_t OnlineAligner::waiting() const { return queue_->waiting(); }

}  // namespace crisp
