// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

#include <crisp/rig.hpp>

#include "grabbers/wire/plate_sentence.hpp"

namespace crisp::wire {

/// Longest line of a user's own format, without its line end; longer lines are damage.
inline constexpr std::size_t kLongestEncoderLine = 512;

/// Reads one line without its line end in the user's own format. Two columns are apart by one separator and
/// any blanks about it, where the format has blanks; columns count behind the format's `begin`.
/// @param reading  receives the count modulo 2^32 and, where the format has a time, device_us modulo 2^32
PlateFailure decode_encoder_line(std::string_view line, const EncoderLine& format, PlateReading& reading);

/// Reads one line of an encoder, without its line end: a sentence of $PPLT, or a line of the user's own
/// format. A line without a time has that of its receipt.
/// @param reading  with its receipt_ns; receives all else but for a sequence that the line does not have
PlateFailure decode_plate_line(std::string_view line, const std::optional<EncoderLine>& own,
                               PlateReading& reading);

}  // namespace crisp::wire
