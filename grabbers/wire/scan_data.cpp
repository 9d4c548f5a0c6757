// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/scan_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include <crisp/error.hpp>

#include "grabbers/wire/binary_fields.hpp"
#include "grabbers/wire/text_fields.hpp"

namespace crisp::wire {
namespace {

// The order of the fields is written once, as functions of a "wire": a reader or a writer of either language.
// Reading changes the data, writing takes them const.

constexpr std::size_t kChannelName = 5;
constexpr std::size_t kEventKind = 4;
constexpr std::size_t kMaxBlocks = 64;  // more than any device sends; bounds what a damaged count can cost

template <class Wire>
bool flag(Wire& wire, bool present) {
  std::uint16_t value = present ? 1 : 0;
  wire.number(value);
  if constexpr (Wire::kReads) {
    if (value > 1) wire.fail(FieldFailure::BadFlag);
    return wire.ok() && value == 1;
  }
  return present;
}

template <class Wire, class Optional, class Fields>
void optional(Wire& wire, Optional& value, Fields fields) {
  const bool present = flag(wire, value.has_value());
  if constexpr (Wire::kReads) {
    value.reset();
    if (present) value.emplace();
  }
  if (present) fields(*value);
}

template <class Wire, class Blocks, class Fields>
void list(Wire& wire, Blocks& blocks, Fields fields) {
  auto count = static_cast<std::uint16_t>(blocks.size());
  wire.number(count);
  if constexpr (Wire::kReads) {
    if (count > kMaxBlocks) wire.fail(FieldFailure::TooMany);
    blocks.resize(wire.ok() ? count : 0);
  }
  for (auto& block : blocks) fields(block);
}

template <class Wire, class Number>
void low_byte_first(Wire& wire, Number& value) {
  auto low = static_cast<std::uint8_t>(value), high = static_cast<std::uint8_t>(value >> 8);
  wire.number(low);
  wire.number(high);
  if constexpr (Wire::kReads) value = static_cast<std::uint16_t>(low | high << 8);
}

template <class Wire, class Text>
void counted_text(Wire& wire, Text& text) {
  auto length = static_cast<std::uint8_t>(text.size());
  wire.number(length);
  wire.text(text, length);
}

template <class Wire, class Block>
void encoder(Wire& wire, Block& block, EncoderWidths widths) {
  if (widths == EncoderWidths::Position32) {
    auto speed = static_cast<std::int16_t>(block.speed);
    wire.number(block.position);
    wire.number(speed);
    if constexpr (Wire::kReads) block.speed = speed;
  } else {
    auto position = static_cast<std::uint16_t>(block.position),
         speed = static_cast<std::uint16_t>(block.speed);
    wire.number(position);
    wire.number(speed);
    if constexpr (Wire::kReads) block = {position, speed};
  }
}

template <class Wire, class Block>
void channel(Wire& wire, Block& block, std::size_t width) {
  wire.text(block.name, kChannelName);
  wire.real(block.scale);
  wire.real(block.offset);
  wire.number(block.start_angle);
  wire.number(block.angle_step);
  auto count = static_cast<std::uint16_t>(block.raw.size());
  wire.number(count);
  wire.values(block.raw, count, width);
}

template <class Wire, class Block>
void time(Wire& wire, Block& block) {
  wire.number(block.year);
  wire.number(block.month);
  wire.number(block.day);
  wire.number(block.hour);
  wire.number(block.minute);
  wire.number(block.second);
  wire.number(block.microsecond);
}

template <class Wire, class Data>
void fields(Wire& wire, Data& data, EncoderWidths widths) {
  wire.number(data.version);
  wire.number(data.device_number);
  wire.number(data.serial_number);
  low_byte_first(wire, data.device_status);
  wire.number(data.telegram_counter);
  wire.number(data.scan_counter);
  wire.number(data.scan_time_us);
  wire.number(data.transmission_time_us);
  low_byte_first(wire, data.digital_inputs);
  low_byte_first(wire, data.digital_outputs);
  wire.number(data.layer);
  wire.number(data.scan_frequency);
  wire.number(data.measurement_frequency);
  list(wire, data.encoders, [&](auto& block) { encoder(wire, block, widths); });
  list(wire, data.channels16, [&](auto& block) { channel(wire, block, 2); });
  list(wire, data.channels8, [&](auto& block) { channel(wire, block, 1); });
  optional(wire, data.position, [&](auto& block) {
    for (auto& value : block.pose) wire.real(value);
    wire.number(block.rotation_type);
  });
  optional(wire, data.name, [&](auto& text) { counted_text(wire, text); });
  optional(wire, data.comment, [&](auto& text) { counted_text(wire, text); });
  optional(wire, data.time, [&](auto& block) { time(wire, block); });
  optional(wire, data.event, [&](auto& block) {
    wire.text(block.kind, kEventKind);
    wire.number(block.encoder_position);
    wire.number(block.time);
    wire.number(block.angle);
  });
}

void require(bool fits, std::string_view what) {
  if (!fits) throw Error(fmt::format("a scan telegram cannot hold {}", what), "see the fields of ScanData");
}

void check(const ChannelBlock& block, std::uint16_t largest) {
  require(block.name.size() == kChannelName,
          fmt::format("the channel name \"{}\": it has not 5 characters", block.name));
  require(block.raw.size() <= std::numeric_limits<std::uint16_t>::max(),
          "more than 65535 values in a channel");
  require(std::all_of(block.raw.begin(), block.raw.end(), [&](auto v) { return v <= largest; }),
          fmt::format("values above {} in {}", largest, block.name));
}

void check(const ScanData& data, EncoderWidths widths) {
  require(std::max({data.encoders.size(), data.channels16.size(), data.channels8.size()}) <= kMaxBlocks,
          fmt::format("more than {} encoders or channels", kMaxBlocks));
  const bool narrow = widths == EncoderWidths::Position16;
  for (const auto& block : data.encoders) {
    require(!narrow || block.position <= 0xFFFF, "an encoder position above 65535 in 16 bits");
    require(
        narrow ? block.speed >= 0 && block.speed <= 0xFFFF : block.speed >= -0x8000 && block.speed <= 0x7FFF,
        "an encoder speed outside 16 bits");
  }
  for (const auto& block : data.channels16) check(block, 0xFFFF);
  for (const auto& block : data.channels8) check(block, 0xFF);
  require(data.name.value_or("").size() <= 0xFF, "a name of more than 255 bytes");
  require(data.comment.value_or("").size() <= 0xFF, "a comment of more than 255 bytes");
  require(!data.event || data.event->kind.size() == kEventKind, "an event whose kind has not 4 characters");
}

}  // namespace

double measurement_frequency_hz(const ScanData& data) {
  constexpr std::uint32_t kLargestInHundreds = 10000;
  return data.measurement_frequency > kLargestInHundreds ? data.measurement_frequency
                                                         : 100.0 * data.measurement_frequency;
}

FieldFailure decode_scan_data(const ColaTelegram& telegram, EncoderWidths widths, ScanData& data) {
  if (telegram.language == ColaLanguage::B) {
    BinaryReader reader(telegram.parameters);
    fields(reader, data, widths);
    data.appended = reader.remaining();
    return reader.failure();
  }
  TextReader reader(as_text(telegram.parameters));
  fields(reader, data, widths);
  data.appended = reader.count_tokens();
  return reader.failure();
}

void append_scan_data(const ScanData& data, ColaLanguage language, std::string_view command,
                      EncoderWidths widths, Bytes& out) {
  check(data, widths);
  const auto start = fmt::format("{} {}", command, kScanDataName);
  Bytes payload(start.begin(), start.end());
  if (language == ColaLanguage::B) {
    payload.push_back(' ');
    BinaryWriter writer(payload);
    fields(writer, data, widths);
  } else {
    TextWriter writer(payload);
    fields(writer, data, widths);
  }
  append_cola_frame(payload, language, out);
}

Bytes encode_scan_data(const ScanData& data, ColaLanguage language) {
  Bytes out;
  append_scan_data(data, language, "sSN", EncoderWidths::Position32, out);
  return out;
}

}  // namespace crisp::wire
