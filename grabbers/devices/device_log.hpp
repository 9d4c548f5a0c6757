// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <crisp/capture_statistics.hpp>
#include <crisp/scan.hpp>

#include "grabbers/devices/device_timeline.hpp"
#include "grabbers/devices/running_median.hpp"
#include "grabbers/wire/cola_framer.hpp"
#include "grabbers/wire/scan_conversion.hpp"
#include "pipeline/data/pool.hpp"

namespace crisp::devices {

/// Follows what one device sends: turns its telegrams into scans or readings, each given once, and keeps
/// count.
class DeviceLog {
 public:
  /// @param laser  index of the laser in the rig
  /// @param pauses of all devices of a capture, if there may be several recordings in it; outlives this
  DeviceLog(DeviceKind kind, std::string name, Address address, std::uint16_t laser = 0,
            clocks::Pauses* pauses = nullptr);

  /// A telegram of a laser; gives a scan if it holds one that did not come before, otherwise nullptr.
  std::shared_ptr<const Scan> take(const wire::ColaFrame& frame, EncoderWidths widths);
  /// A reading of a plate; gives it if it did not come before.
  /// @param kind  what it came as; empty: a sentence, or a line of the user's own
  std::optional<PlateReading> take(const PlateReading& reading, std::string_view kind = {});
  /// A telegram that TCP sent again after it had come.
  void note_repeated(const wire::ColaFrame& frame);

  void lose(std::string_view what, std::uint64_t n = 1) { statistics_.losses.add(what, n); }
  void note(std::string_view what, std::uint64_t n = 1) { statistics_.notes.add(what, n); }

  DeviceStatistics statistics() const;

 private:
  std::shared_ptr<const Scan> take_scan(const wire::ColaTelegram& telegram, std::int64_t time_ns,
                                        EncoderWidths widths);
  bool is_new(const DeviceTimeline::Item& item);
  void lose_scan(std::string_view why);
  void count_telegram(std::string_view kind);
  void note_scan(const Scan& scan);
  void note_count(std::uint32_t count);

  DeviceStatistics statistics_;
  std::uint16_t laser_ = 0;
  DeviceTimeline timeline_;
  wire::ScanData data_;
  data::Pool<Scan> scans_;
  std::string kind_;  ///< of a telegram: here to keep its memory
  RunningMedian handover_, period_;
  std::optional<std::pair<std::uint16_t, std::uint32_t>> last_scan_;  ///< its counter and time
  std::optional<std::uint32_t> last_serial_number_;
  std::optional<std::uint32_t> last_count_;  ///< of an encoder
};

}  // namespace crisp::devices
