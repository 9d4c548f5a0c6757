// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include <crisp/scan.hpp>

#include "grabbers/wire/bytes.hpp"

namespace crisp::wire {

/// Longest plausible payload of one telegram [bytes].
inline constexpr std::size_t kLargestColaPayload = 64 * 1024;

/// One telegram, its payload taken apart; views into the payload.
struct ColaTelegram {
  ColaLanguage language = ColaLanguage::B;
  std::string_view command;  ///< "sSN", "sRA", "sFA" …
  std::string_view name;     ///< "LMDscandata", the whole name; empty for sFA
  ByteView parameters;       ///< what follows the name and its space
};

/// Appends `payload` with the framing of `language` to `out`.
/// @throws Error if the payload is empty or longer than kLargestColaPayload
void append_cola_frame(ByteView payload, ColaLanguage language, Bytes& out);

/// Frames one payload.
Bytes cola_frame(ByteView payload, ColaLanguage language);

/// Exclusive or of all bytes: the checksum of CoLa-B.
std::uint8_t cola_checksum(ByteView payload);

/// Parses a payload (without framing); nothing if it does not begin like a telegram.
std::optional<ColaTelegram> parse_cola(ByteView payload, ColaLanguage language);

/// The code of an sFA telegram; nothing for other telegrams and for codes that cannot be read.
std::optional<unsigned> cola_error_code(const ColaTelegram& telegram);

/// Meaning of the code of an sFA telegram, in words.
std::string_view cola_error_text(unsigned code);

}  // namespace crisp::wire
