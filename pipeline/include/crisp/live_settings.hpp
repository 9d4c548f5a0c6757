// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <crisp/scan.hpp>

namespace crisp {

/// [ns since the Unix epoch] The hub's clock.
using HubClock = std::function<std::int64_t()>;

/// [ns since the Unix epoch] This machine's clock.
std::int64_t now_ns();

/// Requested settings of a laser; absent ones stay unchanged.
struct SickConfiguration {
  std::optional<double> frequency;   ///< [Hz] of the mirror
  std::optional<double> resolution;  ///< [rad] from beam to beam
  std::vector<double> output_range;  ///< [rad] first and last angle, as the device reports them; or empty
  std::optional<bool> remission;     ///< whether remissions are sent
  bool encoder = false;              ///< whether counts of an encoder at the laser are sent with these
  bool ntp_off = false;              ///< the device's clock is not to be set over the network

  /// Whether the mirror's frequency or the resolution is to change.
  bool sets_mirror() const { return frequency || resolution; }
  /// Whether nothing is to change.
  bool is_empty() const { return !sets_mirror() && output_range.empty() && !remission && !ntp_off; }
};

/// How a SICK laser is spoken to.
struct SickSettings {
  ColaLanguage language = ColaLanguage::B;  ///< that is tried first
  bool start = true;                ///< log in and start the measurement; otherwise only request scans
  SickConfiguration configuration;  ///< how lasers are to measure, where anything is wanted
  double reply_timeout = 1;         ///< [s] for a connection, and for each answer
  double silence = 2;               ///< [s] without a scan after which the connection is made anew
  double max_reconnect_delay = 5;   ///< [s] between two tries; the first are quicker
  EncoderWidths encoder_widths = EncoderWidths::Position32;  ///< of encoders that are wired to lasers
};

/// Transport of the plate's sentences.
enum class PlateTransport : std::uint8_t {
  Datagrams,  ///< by UDP, from the rig's plate
  Tcp,        ///< the rig's plate is a TCP server
  Serial,     ///< over a serial line of this machine: 8 data bits, no parity, 1 stop bit
};

/// Where and how the plate's encoder readings are received.
struct PlateSettings {
  PlateTransport transport = PlateTransport::Datagrams;  ///< how the sentences come
  std::string listen = "127.0.0.1";   ///< the hub's address that datagrams are taken at; 0.0.0.0: all of them
  std::optional<std::uint16_t> port;  ///< of the hub; 0: any that is free; nothing: the rig's, or 4000
  std::string serial = "/dev/ttyUSB0";  ///< the serial line's device
  unsigned baud = 115200;               ///< [bit/s] of the serial line
  double silence = 2;              ///< [s] without a reading after which a connection or line is opened anew
  double max_reconnect_delay = 5;  ///< [s] between two tries; the first are quicker
};

/// Settings of a live scanner.
struct LiveSettings {
  bool lasers = true;      ///< whether the rig's lasers are connected
  bool plate = true;       ///< whether the plate is received
  SickSettings sick;       ///< of the lasers
  PlateSettings plate_at;  ///< of the plate
  std::size_t queue =
      16384;  ///< items that may wait for the pipeline; then the oldest are dropped, and counted
  HubClock clock = now_ns;  ///< stamps the receipts
};

}  // namespace crisp
