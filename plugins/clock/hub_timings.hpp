// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <crisp/clock_aligner.hpp>
#include <crisp/rig.hpp>

#include "pipeline/clocks/pauses.hpp"
#include "pipeline/data/pool.hpp"
#include "plugins/clock/encoder_timestamper.hpp"
#include "plugins/clock/scan_timestamper.hpp"

namespace crisp::clock {

/// An aligner's tracks of a rig's devices.
class HubTimings {
 public:
  HubTimings(const Rig& rig, const AlignmentSettings& settings);

  /// Notes that something was received. @return [s since the epoch] when
  double arrive(std::int64_t receipt_ns);
  /// Whether this receipt ends a pause, in which nothing came from any device.
  bool ends_pause(std::int64_t receipt_ns) const { return pauses_.end_before(receipt_ns); }
  /// Forgets all but the epoch and where the plate was: what comes now is of another recording.
  void begin_anew();
  /// The track that a scan belongs to; nullptr, and counted, if the rig has no such laser.
  ScanTimestamper* track_of(const Scan& scan);

  std::vector<ScanTimestamper>& lasers() { return lasers_; }
  const std::vector<ScanTimestamper>& lasers() const { return lasers_; }
  /// Measurements of a scan, on the hub's clock.
  std::shared_ptr<const Measurements> measurements_of(const TimedScan& scan);
  EncoderTimestamper& plate() { return plate_; }
  const EncoderTimestamper& plate() const { return plate_; }
  std::int64_t epoch_ns() const { return epoch_ns_; }
  double now() const { return now_; }  ///< [s since the epoch] latest receipt

  std::uint64_t scans_left_out() const;  ///< of this recording, received and not handed out
  bool has_scans() const;                ///< of any laser
  bool has_readings() const;             ///< of the plate, two or more
  /// @throws Error as Aligner::finish()
  void refuse_if_missing() const;
  void finish_clocks();
  std::vector<DeviceReport> reports() const;
  AlignmentReport report() const;

 private:
  Rig rig_;
  AlignmentSettings settings_;
  std::vector<ScanTimestamper> lasers_;
  EncoderTimestamper plate_;
  data::Pool<Measurements> measurements_;
  clocks::Pauses pauses_;
  std::int64_t epoch_ns_ = 0;
  bool begun_ = false;
  std::optional<double> begin_;  ///< [s since the epoch] of the present recording
  double now_ = 0;
  std::uint64_t unknown_lasers_ = 0;
  std::uint64_t handed_out_ = 0;  ///< scans of the present recording
  std::uint64_t back_in_time_ = 0;
};

}  // namespace crisp::clock
