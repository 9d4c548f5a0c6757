// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/scan.hpp>

namespace crisp {

/// Network address of a device, or of its packets' sender.
struct Address {
  std::string ip;          ///< "192.168.0.1"
  std::uint16_t port = 0;  ///< 0: any
  /// Whether IP address and port are the same.
  bool operator==(const Address&) const = default;
};

/// One laser of a rig with what is known of it before any calibration.
struct RigLaser {
  std::string name;                     ///< "laser1": of a-z, 0-9 and _
  Address address;                      ///< on the hub's network
  std::string topic;                    ///< of its scans in a bag; empty: the only one of scans
  std::optional<int> ring;              ///< of that topic's points which are its: a 3D laser has several
  double mount = 0;                     ///< [rad] θ = reported angle − mount
  double time_offset = 0;               ///< [s] from the scan's stamp to its first possible beam
  EchoChoice echo = EchoChoice::first;  ///< which of a beam's echoes is measured
  int period_offset = 0;     ///< whole mirror periods between them (−1: the stamp is one period late)
  LaserCalibration nominal;  ///< the values to start from; a std_error of 0: the rig gives none
};

/// The unit in which a bag's message gives the plate's angle.
enum class AngleUnit { rad, deg, counts };

/// Checksum behind the last `*` of a line of text: two hexadecimal digits, over all bytes before the `*` but
/// for a leading `$`.
enum class LineChecksum : std::uint8_t {
  none,
  exclusive_or,  ///< of the bytes, as in NMEA 0183
  crc8           ///< polynomial 0x07 from 0 (CRC-8/SMBUS)
};

/// The line of text for each encoder reading that a microcontroller of the user's own sends.
struct EncoderLine {
  std::string begin;                           ///< of each such line: others are not read
  std::string separators = ",; \t";            ///< one or more of them between two columns
  std::size_t count_column = 1;                ///< from 1, behind `begin`
  std::optional<std::size_t> time_column;      ///< from 1; nothing: readings carry the time of their receipt
  double time_unit = 1e-6;                     ///< [s] of that column's numbers
  LineChecksum checksum = LineChecksum::none;  ///< at the line's end
};

/// The plate and its encoder.
struct RigPlate {
  std::string name = "plate";               ///< by which messages call it
  Address address;                          ///< on the hub's network
  std::string topic;                        ///< of its angles in a bag; empty: the only one of joint states
  std::string joint;                        ///< of a joint state; empty: the only one
  std::string field;                        ///< of a message of another type: "data"
  std::optional<AngleUnit> unit;            ///< of that field; else rad, or counts where it is a whole number
  std::optional<std::uint16_t> encoder_of;  ///< laser whose telegrams carry its encoder
  std::optional<EncoderLine> line;          ///< of its encoder; nothing: the sentences of $PPLT
  double counts_per_revolution = 16384;     ///< [encoder steps]
  CountDirection direction = CountDirection::counter_clockwise;  ///< in which it counts up

  /// [rad] By how much one count turns the plate; negative where it counts clockwise.
  double angle_per_count() const;
};

/// The scanner: what is screwed to what, and under which address it speaks.
struct Rig {
  std::vector<RigLaser> lasers;  ///< Measurements::laser is an index into them
  RigPlate plate;                ///< that carries the lasers
};

/// The calibration that a rig's nominal values make.
Calibration nominal_calibration(const Rig& rig);

/// The rig of configs/rig.yaml: three LMS-151, τ = 0.20 m, α = 0, λ = 0°, 120°, 240°, η = 0, mount = 45°.
Rig default_rig();

}  // namespace crisp
