// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "grabbers/wire/cola.hpp"

namespace crisp::wire {

/// A parameter of a request or an answer, with the type that gives it its width in CoLa-B.
using ColaValue = std::variant<std::uint8_t, std::uint16_t, std::uint32_t, std::int32_t, std::string>;

/// One framed telegram, `sMN SetAccessMode` with its parameters.
/// @throws Error if it is longer than kLargestColaPayload
Bytes cola_message(std::string_view command, std::string_view name, const std::vector<ColaValue>& parameters,
                   ColaLanguage language);

/// `sFA` with its code.
Bytes cola_error(std::uint16_t code, ColaLanguage language);

/// The first parameter, an unsigned number of one byte; nothing if there is none.
std::optional<unsigned> first_byte(const ColaTelegram& telegram);

}  // namespace crisp::wire
