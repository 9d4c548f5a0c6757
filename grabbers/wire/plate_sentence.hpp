// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <crisp/scan.hpp>

namespace crisp::wire {

/// Longest sentence of the plate, without its line end; longer lines are damage.
inline constexpr std::size_t kLongestPlateSentence = 82;  // NMEA 0183's limit

/// Why a line is no encoder reading.
enum class PlateFailure : std::uint8_t {
  None,
  OtherSentence,  ///< a good sentence of another kind ("$GPRMC,…")
  Truncated,      ///< the line ends too early
  BadChecksum,    ///< the checksum is wrong, or is not two upper-case hexadecimal digits
  BadField,       ///< a field is missing, no decimal number, or out of its range
};

std::string_view to_string(PlateFailure failure);

/// Reads one line without its line end, "$PPLT,7,1523342,1004211*04", into `reading`; receipt_ns stays as it
/// is.
PlateFailure decode_plate_sentence(std::string_view line, PlateReading& reading);

/// The sentence of one reading with its line end.
std::string encode_plate_sentence(const PlateReading& reading);

}  // namespace crisp::wire
