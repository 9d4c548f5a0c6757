// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/cola.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

#include <crisp/error.hpp>

#include "grabbers/wire/binary_fields.hpp"
#include "grabbers/wire/text_fields.hpp"

namespace crisp::wire {
namespace {

constexpr std::array<std::string_view, 26> kErrorTexts = {
    "no error",
    "access to the method denied at this user level: log in first",
    "unknown method",
    "unknown variable",
    "local condition failed: a value is out of range",
    "invalid data",
    "unknown error",
    "buffer overflow: too many parameters",
    "buffer underflow: too few parameters",
    "unknown type",
    "write access denied at this user level: log in first",
    "unknown command for the name server",
    "unknown CoLa command",
    "server busy: retry later",
    "array index out of bounds",
    "unknown event",
    "value too large for its type",
    "invalid character",
    "no message",
    "no answer message",
    "internal error of the device",
    "hub address corrupted",
    "hub address cannot be decoded",
    "hub address exceeded",
    "blank expected in the hub address",
    "asynchronous methods are suppressed",
};

constexpr unsigned kComplexArraysNotSupported = 0x20;

bool is_upper(std::uint8_t c) { return c >= 'A' && c <= 'Z'; }

}  // namespace

std::uint8_t cola_checksum(ByteView payload) {
  return std::accumulate(payload.begin(), payload.end(), std::uint8_t{0}, std::bit_xor<>());
}

void append_cola_frame(ByteView payload, ColaLanguage language, Bytes& out) {
  if (payload.empty() || payload.size() > kLargestColaPayload) {
    throw Error(fmt::format("a telegram of {} bytes cannot be framed", payload.size()),
                fmt::format("a payload has 1 to {} bytes", kLargestColaPayload));
  }
  if (language == ColaLanguage::A) {
    out.push_back(0x02);
    out.insert(out.end(), payload.begin(), payload.end());
    out.push_back(0x03);
    return;
  }
  out.insert(out.end(), 4, 0x02);
  BinaryWriter(out).number(static_cast<std::uint32_t>(payload.size()));
  out.insert(out.end(), payload.begin(), payload.end());
  out.push_back(cola_checksum(payload));
}

Bytes cola_frame(ByteView payload, ColaLanguage language) {
  Bytes out;
  append_cola_frame(payload, language, out);
  return out;
}

std::optional<ColaTelegram> parse_cola(ByteView payload, ColaLanguage language) {
  if (payload.size() < 3 || payload[0] != 's' || !is_upper(payload[1]) || !is_upper(payload[2])) return {};
  ColaTelegram telegram{.language = language, .command = as_text(payload.first(3))};
  auto rest = payload.subspan(3);
  const bool error = telegram.command == "sFA";  // CoLa-B puts no space between sFA and its code
  if (!rest.empty() && rest[0] == ' ') {
    rest = rest.subspan(1);
  } else if (!error) {
    return {};
  }
  if (!error) {
    const auto length = static_cast<std::size_t>(std::find(rest.begin(), rest.end(), ' ') - rest.begin());
    telegram.name = as_text(rest.first(length));
    rest = rest.subspan(std::min(length + 1, rest.size()));
  }
  telegram.parameters = rest;
  return telegram;
}

std::optional<unsigned> cola_error_code(const ColaTelegram& telegram) {
  if (telegram.command != "sFA") return {};
  std::uint16_t code = 0;
  const auto read = [&](auto reader) {
    reader.number(code);
    return reader.ok() && reader.remaining() == 0;
  };
  const bool good = telegram.language == ColaLanguage::A ? read(TextReader(as_text(telegram.parameters)))
                                                         : read(BinaryReader(telegram.parameters));
  if (!good) return {};
  return code;
}

std::string_view cola_error_text(unsigned code) {
  if (code < kErrorTexts.size()) return kErrorTexts[code];
  if (code == kComplexArraysNotSupported) return "complex arrays are not supported";
  return "a code that the manuals do not list";
}

}  // namespace crisp::wire
