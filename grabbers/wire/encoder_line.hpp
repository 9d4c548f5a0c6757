// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include <crisp/rig.hpp>

#include "grabbers/wire/plate_sentence.hpp"

namespace crisp {

/// Reads one line without its line end in the user's own format. Two columns are apart by one separator and
/// any blanks about it, where the format has blanks; columns count behind the format's `begin`.
/// @param reading  receives the count modulo 2^32 and, where the format has a time, device_us modulo 2^32
PlateFailure decode_encoder_line(std::string_view line, const EncoderLine& format, PlateReading& reading);

}  // namespace crisp
