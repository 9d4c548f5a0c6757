// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <crisp/rig.hpp>

namespace crisp {

/// Events, mostly losses, by a name that a person understands: "packets cut short by the capture".
class Counts {
 public:
  /// Adds n events of this name.
  void add(std::string_view name, std::uint64_t n = 1) {
    if (n == 0) return;
    const auto found = counts_.find(name);
    if (found != counts_.end()) {
      found->second += n;
    } else {
      counts_.emplace(name, n);
    }
  }
  /// Adds all events of another list.
  void add(const Counts& other) {
    for (const auto& [name, n] : other.counts_) add(name, n);
  }
  /// The number of events of this name; 0 if there was none.
  std::uint64_t of(std::string_view name) const {
    const auto found = counts_.find(name);
    return found == counts_.end() ? 0 : found->second;
  }
  /// All numbers, by name.
  const std::map<std::string, std::uint64_t, std::less<>>& all() const { return counts_; }
  /// Whether all numbers are the same.
  bool operator==(const Counts&) const = default;

 private:
  std::map<std::string, std::uint64_t, std::less<>> counts_;
};

/// Losses by a device's own counter.
inline constexpr std::string_view kTelegramsNeverCame = "lost telegrams, by their counter";
inline constexpr std::string_view kReadingsNeverCame = "lost readings, by their sequence number";

enum class DeviceKind : std::uint8_t { Laser, Plate };

/// The shape of a laser's scans, by its last telegram.
struct ScanShape {
  std::size_t beams = 0;    ///< of one scan
  double start_angle = 0;   ///< [rad] as the device reports it
  double angle_step = 0;    ///< [rad]
  std::size_t echoes = 0;   ///< of one beam, at most
  bool remissions = false;  ///< whether it sends any
  bool encoder = false;     ///< whether its telegrams carry an encoder's readings
};

/// Statistics of one device in a capture.
struct DeviceStatistics {
  DeviceKind kind = DeviceKind::Laser;  ///< what sends such telegrams
  std::string name;                     ///< as the rig calls it; empty if the rig does not know it
  Address address;                      ///< from where its packets came
  std::uint64_t items = 0;              ///< different scans or readings
  std::uint64_t unreadable = 0;         ///< scan telegrams of which no scan could be made
  std::uint64_t standing = 0;           ///< items with the stamp of the one before
  Counts telegrams;                     ///< all that it sent, by kind
  Counts losses;                        ///< what is missing, by reason
  Counts notes;                         ///< what was out of the ordinary without loss
  std::int64_t first_ns = 0;            ///< [ns since the Unix epoch] receipt of the first item
  std::int64_t last_ns = 0;             ///< [ns since the Unix epoch] receipt of the last item
  double longest_silence = 0;           ///< [s] without an item of it; pauses between recordings are included
  std::int64_t silence_ns = 0;          ///< [ns since the Unix epoch] when that began
  std::uint64_t pauses = 0;             ///< between recordings: nothing came from any device
  std::int64_t paused_ns = 0;           ///< [ns] from last to first items around them
  std::vector<std::uint32_t> serial_numbers;  ///< of a laser
  std::uint64_t serial_changes = 0;           ///< scans with another serial number than the one before
  std::uint64_t counted_up = 0;               ///< steps of an encoder forwards, from reading to reading
  std::uint64_t counted_down = 0;             ///< and back
  std::optional<double> median_handover;      ///< [s] transmission time − scan time, median
  std::optional<double> period;  ///< [s] of the mirror, measured by the laser's own clock, median
  std::optional<double> skew;    ///< hub seconds per second of its clock, less 1: a rough estimate
  double nominal_frequency = 0;  ///< [Hz] that a laser claims
  ScanShape shape;               ///< of a laser's scans

  /// [Hz] items a second within recordings, 0 for fewer than two.
  double rate() const;
  /// The number of whole mirror periods by which the stamps seem to be late, as a rig's `period_offset`: −1
  /// where a scan is handed out before it can be over (median handover below 0.75 periods), otherwise 0.
  int period_hint() const;
};

/// Statistics of a capture, with its losses.
struct CaptureStatistics {
  std::uint64_t packets = 0;         ///< in the capture, of any sender
  std::uint64_t bytes = 0;           ///< of the packets
  std::uint64_t file_bytes = 0;      ///< read from the file
  std::uint64_t truncated = 0;       ///< packets of which the recording kept a part only (its snap length)
  std::int64_t first_ns = 0;         ///< [ns since the Unix epoch] time of the first packet
  std::int64_t last_ns = 0;          ///< [ns since the Unix epoch] time of the last packet
  std::uint64_t pauses = 0;          ///< of kPause and more, between recordings: nothing came at all
  double paused = 0;                 ///< [s] in all
  Counts link_types;                 ///< packets by link type
  Counts losses;                     ///< what the file or the network lost, not attributed to a device
  Counts notes;                      ///< what was out of the ordinary without loss
  std::vector<std::string> remarks;  ///< on the order of the packets
  std::vector<DeviceStatistics>
      devices;  ///< the rig's in its order, then the unknown ones in order of address
};

}  // namespace crisp
