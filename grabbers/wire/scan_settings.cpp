// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/scan_settings.hpp"

#include "grabbers/wire/binary_fields.hpp"
#include "grabbers/wire/text_fields.hpp"

namespace crisp::wire {
namespace {

constexpr unsigned kByte = 8;

std::uint8_t low(std::uint16_t value) { return static_cast<std::uint8_t>(value); }
std::uint8_t high(std::uint16_t value) { return static_cast<std::uint8_t>(value >> kByte); }
std::uint8_t flag(bool value) { return value ? 1 : 0; }

/// Has `fields` read a telegram's parameters in its language. @return whether all were there
template <class Fields>
bool read_parameters(const ColaTelegram& telegram, const Fields& fields) {
  const auto read = [&](auto reader) {
    fields(reader);
    return reader.ok();
  };
  return telegram.language == ColaLanguage::A ? read(TextReader(as_text(telegram.parameters)))
                                              : read(BinaryReader(telegram.parameters));
}

/// Two bytes, the low one first.
template <class Reader>
void read_pair(Reader& reader, std::uint16_t& value) {
  std::uint8_t first = 0;
  std::uint8_t second = 0;
  reader.number(first);
  reader.number(second);
  value = static_cast<std::uint16_t>(first | (second << kByte));
}

template <class Reader>
void read_flag(Reader& reader, bool& value) {
  std::uint8_t number = 0;
  reader.number(number);
  value = number != 0;
}

}  // namespace

std::vector<ColaValue> to_values(const ScanSettings& s) {
  return {s.frequency, s.sectors, s.resolution, s.first, s.last};
}

std::optional<ScanSettings> scan_settings(const ColaTelegram& telegram, bool with_status) {
  ScanSettings s;
  const bool good = read_parameters(telegram, [&](auto& reader) {
    std::uint8_t status = 0;
    if (with_status) reader.number(status);
    reader.number(s.frequency);
    reader.number(s.sectors);
    reader.number(s.resolution);
    reader.number(s.first);
    reader.number(s.last);
  });
  return good ? std::optional(s) : std::nullopt;
}

std::vector<ColaValue> to_values(const OutputRange& range) {
  return {std::uint16_t{1}, range.resolution, range.first, range.last};
}

std::optional<OutputRange> output_range(const ColaTelegram& telegram) {
  OutputRange range;
  std::uint16_t count = 0;
  const bool good = read_parameters(telegram, [&](auto& reader) {
    reader.number(count);
    reader.number(range.resolution);
    reader.number(range.first);
    reader.number(range.last);
  });
  return good && count == 1 ? std::optional(range) : std::nullopt;
}

std::vector<ColaValue> to_values(const ScanContent& c) {
  return {low(c.channels), high(c.channels), flag(c.remission), flag(c.wide),
          c.unit,          low(c.encoders),  high(c.encoders),  flag(c.position),
          flag(c.name),    flag(c.comment),  flag(c.time),      c.interval};
}

std::optional<ScanContent> scan_content(const ColaTelegram& telegram) {
  ScanContent c;
  const bool good = read_parameters(telegram, [&](auto& reader) {
    read_pair(reader, c.channels);
    read_flag(reader, c.remission);
    read_flag(reader, c.wide);
    reader.number(c.unit);
    read_pair(reader, c.encoders);
    for (bool* value : {&c.position, &c.name, &c.comment, &c.time}) read_flag(reader, *value);
    reader.number(c.interval);
  });
  return good ? std::optional(c) : std::nullopt;
}

}  // namespace crisp::wire
