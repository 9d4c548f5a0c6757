// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <crisp/scan.hpp>

#include "grabbers/wire/bytes.hpp"
#include "grabbers/wire/cola.hpp"
#include "grabbers/wire/fields.hpp"

namespace crisp::wire {

inline constexpr double kUnitsPerDegree = 1e4;  ///< of angles in telegrams

/// The name of the telegram below, whole: other telegrams' names begin with it.
inline constexpr std::string_view kScanDataName = "LMDscandata";

/// One reading of an encoder wired to the laser.
struct EncoderBlock {
  std::uint32_t position = 0;  ///< [counts]
  std::int32_t speed = 0;      ///< device's units
  bool operator==(const EncoderBlock&) const = default;
};

/// One channel of a scan. Value k is raw[k] · scale + offset (mm for DISTn) at start_angle + k · angle_step.
struct ChannelBlock {
  std::string name = "DIST1";  ///< exactly 5 characters: DIST1…, RSSI1…
  float scale = 1;
  float offset = 0;
  std::int32_t start_angle = 0;  ///< [1/10000°]
  std::uint16_t angle_step = 0;  ///< [1/10000°], rounded by the device
  std::vector<std::uint16_t> raw;
  bool operator==(const ChannelBlock&) const = default;
};

/// The device's own estimate of its position.
struct PositionBlock {
  std::array<float, 6> pose{};  ///< x, y, z, three rotations
  std::uint8_t rotation_type = 0;
  bool operator==(const PositionBlock&) const = default;
};

/// The device's calendar clock: 1970-01-01 at power-up unless it was set, in whole milliseconds.
struct TimeBlock {
  std::uint16_t year = 1970;
  std::uint8_t month = 1, day = 1, hour = 0, minute = 0, second = 0;
  std::uint32_t microsecond = 0;
  bool operator==(const TimeBlock&) const = default;
};

/// Trigger of the scan.
struct EventBlock {
  std::string kind = "FDIN";  ///< exactly 4 characters
  std::uint32_t encoder_position = 0;
  std::uint32_t time = 0;
  std::int32_t angle = 0;
  bool operator==(const EventBlock&) const = default;
};

/// LMDscandata with every field that is on the wire, in the device's units. Fields that the wire carries as
/// two bytes, low byte first, are one number here.
struct ScanData {
  std::uint16_t version = 1;  ///< 1 on LMS1xx and TiM, 0 on LMS511
  std::uint16_t device_number = 1;
  std::uint32_t serial_number = 0;
  std::uint16_t device_status = 0;  ///< 0 ok, 1 error, 2 pollution warning, 4 pollution error
  std::uint16_t telegram_counter = 0;
  std::uint16_t scan_counter = 0;
  std::uint32_t scan_time_us = 0;          ///< [µs since power-up] wraps at 2^32
  std::uint32_t transmission_time_us = 0;  ///< [µs] the same clock
  std::uint16_t digital_inputs = 0;
  std::uint16_t digital_outputs = 0;
  std::uint16_t layer = 0;
  std::uint32_t scan_frequency = 5000;        ///< [1/100 Hz] nominal
  std::uint32_t measurement_frequency = 360;  ///< [100 Hz], or [Hz] where above 10000
  std::vector<EncoderBlock> encoders;
  std::vector<ChannelBlock> channels16;  ///< values on the wire in 16 bits
  std::vector<ChannelBlock> channels8;   ///< values on the wire in 8 bits
  std::optional<PositionBlock> position;
  std::optional<std::string> name;     ///< at most 255 bytes
  std::optional<std::string> comment;  ///< at most 255 bytes
  std::optional<TimeBlock> time;
  std::optional<EventBlock> event;
  /// Size of unknown data that a newer firmware appended behind the event: bytes in CoLa-B, tokens in
  /// CoLa-A.
  std::size_t appended = 0;
  bool operator==(const ScanData&) const = default;
};

/// [Hz] whatever the firmware's unit is.
double measurement_frequency_hz(const ScanData& data);

/// Reads the parameters of an LMDscandata telegram (what follows its name) of either language.
/// @param data receives the fields; its memory is used again. Half filled after a failure.
FieldFailure decode_scan_data(const ColaTelegram& telegram, EncoderWidths widths, ScanData& data);

/// Writes LMDscandata as one framed telegram, as a device sends it: `sSN` for an event, `sRA` for an answer.
/// `appended` is not written.
/// @throws Error if a text, a number of values or a value does not fit its field
void append_scan_data(const ScanData& data, ColaLanguage language, std::string_view command,
                      EncoderWidths widths, Bytes& out);

/// The same with the usual `sSN` and encoder widths.
Bytes encode_scan_data(const ScanData& data, ColaLanguage language);

}  // namespace crisp::wire
