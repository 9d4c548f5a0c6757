// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/data/echoes.hpp"
#include "plugins/clock/device_stamps.hpp"
#include "plugins/clock/mirror_smoothing.hpp"
#include "plugins/clock/scan_beams.hpp"

namespace crisp::clock {

/// The scans of one laser on their way to being timed.
class ScanTimestamper {
 public:
  ScanTimestamper(RigLaser laser, DeviceStamps stamps, TimeSource source, std::size_t mirror_half_width)
      : laser_(std::move(laser)),
        stamps_(std::move(stamps)),
        source_(source),
        half_width_(mirror_half_width) {}

  /// @param hub [s since the epoch] receipt
  /// @return whether the clock has another stamp
  /// @throws Error as DeviceStamps::accept
  bool add(std::shared_ptr<const Scan> scan, double hub);
  /// Hands out the scans that begin before `limit` [s since the epoch], up to which the map must be settled.
  void take_before(double limit, std::vector<TimedScan>& out);

  bool idle() const { return pending_.empty(); }
  WindowedClockFit& clock() { return stamps_.clock(); }
  const WindowedClockFit& clock() const { return stamps_.clock(); }
  const RigLaser& laser() const { return laser_; }
  DeviceReport report() const { return stamps_.report(); }
  /// With the silences before its first and after its last scan [s since the epoch].
  DeviceReport report(double begin, double end) const { return stamps_.report(begin, end); }
  std::uint64_t without_ranges() const { return without_ranges_; }
  /// Counts the beams of a scan, and those of them that did not come back.
  void count_beams(const Scan& scan, const Measurements& measurements);
  std::uint64_t without_echo() const { return without_echo_; }  ///< beams
  const data::EchoCounts& echoes() const { return echoes_; }    ///< where the laser sends several
  bool has_no_echoes() const { return beams_ > 0 && without_echo_ == beams_; }
  /// A contradiction between the stamps and the rig's period_offset, or "".
  std::string stamp_warning() const;

 private:
  struct Pending {
    std::shared_ptr<const Scan> scan;
    MirrorStamp stamp;
    double stamp_receipt = 0;  ///< [s since the epoch] receipt, less the time from stamp to transmission
  };
  double base(const Pending& scan, double device_time) const;
  std::size_t count_before(double limit) const;

  RigLaser laser_;
  DeviceStamps stamps_;
  TimeSource source_;
  std::size_t half_width_;
  double nominal_period_ = 0;
  std::int64_t turn_ = 0;
  std::deque<Pending> pending_;
  std::vector<MirrorStamp> taken_;  ///< the last stamps that were handed out: neighbours of the next ones
  DelayHistogram handovers_;        ///< from stamp to transmission
  std::uint64_t without_ranges_ = 0;
  data::EchoCounts echoes_;
  std::uint64_t beams_ = 0;
  std::uint64_t without_echo_ = 0;
};

}  // namespace crisp::clock
