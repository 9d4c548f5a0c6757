// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/telegrams.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

namespace independent {
namespace {

/// Writes fields as tokens (CoLa-A) or packed in big-endian order (CoLa-B).
class Fields {
 public:
  Fields(std::string command, bool is_text) : is_text_(is_text), body_(std::move(command)) {
    if (!is_text_) body_ += ' ';
  }

  void put(std::uint32_t value, int bytes) {
    if (is_text_) {
      char token[12];
      std::snprintf(token, sizeof token, " %X", value);
      body_ += token;
      return;
    }
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
      body_ += static_cast<char>(value >> shift & 0xff);
  }
  void u8(std::uint32_t value) { put(value, 1); }
  void u16(std::uint32_t value) { put(value, 2); }
  void u32(std::uint32_t value) { put(value, 4); }
  void text(const std::string& value) { body_ += (is_text_ ? " " : "") + value; }

  std::string framed() const {
    if (is_text_) return "\x02" + body_ + "\x03";
    std::string frame(4, '\x02');
    for (int shift = 24; shift >= 0; shift -= 8) frame += static_cast<char>(body_.size() >> shift & 0xff);
    char checksum = 0;
    for (const char byte : body_) checksum = static_cast<char>(checksum ^ byte);
    return frame + body_ + checksum;
  }

 private:
  bool is_text_;
  std::string body_;
};

void put_channel_head(Fields& fields, const char* name, const LaserKind& kind, std::size_t values) {
  fields.text(name);
  fields.u32(0x3F800000);  // scale 1
  fields.u32(0);           // offset 0
  fields.u32(static_cast<std::uint32_t>(std::lround(1e4 * kind.start_deg)));
  fields.u16(static_cast<std::uint32_t>(std::lround(1e4 * kind.step_deg)));
  fields.u16(static_cast<std::uint32_t>(values));
}

/// The device's calendar clock: 1970-01-01 at power-up, in whole milliseconds.
void put_calendar(Fields& fields, double seconds) {
  const auto whole = static_cast<std::uint32_t>(seconds);
  fields.u16(1970);
  fields.u8(1);
  fields.u8(1 + whole / 86400);
  fields.u8(whole / 3600 % 24);
  fields.u8(whole / 60 % 60);
  fields.u8(whole % 60);
  fields.u32(1000 * static_cast<std::uint32_t>(1000 * (seconds - whole)));
}

}  // namespace

std::string scan_telegram(const LaserKind& kind, const std::string& name, const WireSetup& wire,
                          const ScanHeader& header, const Scan& scan) {
  Fields fields("sSN LMDscandata", wire.is_text);
  fields.u16(static_cast<std::uint32_t>(kind.version));
  fields.u16(1);  // device number
  fields.u32(header.serial);
  fields.u8(0), fields.u8(0);  // status
  fields.u16(header.telegram_counter);
  fields.u16(header.scan_counter);
  fields.u32(header.stamp_us);
  fields.u32(header.transmission_us);
  fields.u8(0), fields.u8(0);  // inputs
  fields.u8(0), fields.u8(0);  // outputs
  fields.u16(0);               // layer
  fields.u32(static_cast<std::uint32_t>(std::lround(100 * kind.rate)));
  fields.u32(static_cast<std::uint32_t>(std::lround(kind.rate * 360 / kind.step_deg / 100)));
  fields.u16(0);  // encoders
  fields.u16(1);  // 16-bit channels
  put_channel_head(fields, "DIST1", kind, scan.ranges.size());
  for (const auto range : scan.ranges) fields.u16(range);
  fields.u16(1);  // 8-bit channels
  put_channel_head(fields, "RSSI1", kind, scan.remissions.size());
  for (const auto remission : scan.remissions) fields.u8(remission);
  fields.u16(0);  // position
  fields.u16(wire.has_name ? 1 : 0);
  if (wire.has_name) fields.u8(static_cast<std::uint32_t>(name.size())), fields.text(name);
  fields.u16(0);  // comment
  fields.u16(wire.has_time ? 1 : 0);
  if (wire.has_time) put_calendar(fields, header.seconds_since_start);
  fields.u16(0);  // event
  return fields.framed();
}

std::string short_telegram(const std::string& command, int parameter, bool is_text) {
  Fields fields(command, is_text);
  fields.u8(static_cast<std::uint32_t>(parameter));
  return fields.framed();
}

std::string plate_sentence(std::uint16_t sequence, std::uint32_t device_us, std::uint32_t count) {
  const std::string body =
      "PPLT," + std::to_string(sequence) + "," + std::to_string(device_us) + "," + std::to_string(count);
  unsigned checksum = 0;
  for (const char byte : body) checksum ^= static_cast<unsigned char>(byte);
  char tail[8];
  std::snprintf(tail, sizeof tail, "*%02X\r\n", checksum);
  return "$" + body + tail;
}

}  // namespace independent
