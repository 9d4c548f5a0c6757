// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace crisp {

/// The two languages of SICK's devices: CoLa-A is ASCII between STX and ETX, CoLa-B is binary with a length
/// and a checksum.
enum class ColaLanguage : std::uint8_t { A, B };

/// One echo of a beam: the first echoes are element 0 of `Scan::echoes`.
struct Echo {
  std::vector<float> ranges;      ///< [m], one a beam; 0 where the device sent a code (no echo, dazzled …)
  std::vector<float> remissions;  ///< device's units, one a beam, or empty when the device sends none
};

/// Which echoes of a beam are used, where a laser sends several.
enum class EchoChoice : std::uint8_t {
  first,      ///< the first that came back
  last,       ///< the last that came back
  strongest,  ///< the one of the largest remission; without remissions the first
  all         ///< each as a beam of the same instant
};

/// One reading of an incremental encoder that is wired to a laser, as its telegrams carry it.
struct ScanEncoder {
  std::uint32_t position = 0;  ///< [counts]
  std::int32_t speed = 0;      ///< device's units
};

/// How wide the fields of an encoder block are: sources disagree, and no public capture has one.
enum class EncoderWidths : std::uint8_t {
  Position32,  ///< position u32, speed i16 (the drivers)
  Position16,  ///< position u16, speed u16 (the telegram listing of 2012)
};

/// When each beam of a scan was fired.
enum class BeamTiming {
  mirror,  ///< as the mirror turns: a turn takes a period, and the stamp is of the first possible beam, at
           ///< −45°
  stated,  ///< the stamp is of beam 0, and the scan states the time from beam to beam
};

/// One scan telegram of one laser, decoded. Angles are as the device reports them (no mount angle applied):
/// beam k points to start_angle + k * angle_step.
struct Scan {
  std::uint16_t laser = 0;                 ///< index of the laser in the rig
  std::uint32_t serial_number = 0;         ///< of the device; 0 where it sends none
  std::uint16_t device_status = 0;         ///< as the device sends it; 0: no error, no pollution
  std::uint16_t telegram_counter = 0;      ///< wraps at 65536
  std::uint16_t scan_counter = 0;          ///< wraps at 65536
  std::uint32_t scan_time_us = 0;          ///< [µs] device clock; wraps at 2^32
  std::uint32_t transmission_time_us = 0;  ///< [µs] the same clock, when the scan was handed out
  std::int64_t receipt_ns = 0;             ///< [ns since the Unix epoch] hub time of the completing packet
  double scan_frequency = 0;               ///< [Hz] nominal
  double start_angle = 0;                  ///< [rad] reported angle of beam 0
  double angle_step = 0;                   ///< [rad] exact fraction where the telegram rounds
  BeamTiming timing = BeamTiming::mirror;  ///< when each beam was fired
  double beam_interval = 0;                ///< [s] from beam to beam, where that is stated
  std::vector<Echo> echoes;                ///< DIST1/RSSI1, DIST2/RSSI2, …
  std::vector<ScanEncoder> encoders;       ///< that are wired to the laser
  bool numbered = true;  ///< by the device, and all requested: else a gap of its numbers is no loss
  bool timed = true;  ///< by the device's clock: else its times are its number times the nominal period, or
                      ///< its receipt
};

/// One reading of the plate's encoder.
struct PlateReading {
  std::uint16_t sequence = 0;    ///< wraps at 65536; a gap means lost readings
  std::uint32_t device_us = 0;   ///< [µs] the plate's clock; wraps at 2^32
  std::uint32_t count = 0;       ///< [encoder steps] modulo 2^32, growing counter-clockwise seen from +z
  std::int64_t receipt_ns = 0;   ///< [ns since the Unix epoch] hub time of the datagram
  bool numbered = true;          ///< by the device: else nobody counted what was lost
  std::int32_t handover_us = 0;  ///< [µs] of the plate's clock from the reading until it was sent
};

}  // namespace crisp
