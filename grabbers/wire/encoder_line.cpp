// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/encoder_line.hpp"

#include <boost/crc.hpp>
#include <charconv>
#include <cmath>
#include <optional>

namespace crisp::wire {
namespace {

constexpr std::size_t kChecksumDigits = 2;

std::uint8_t checksum_of(std::string_view body, LineChecksum kind) {
  if (kind == LineChecksum::crc8) {
    boost::crc_optimal<8, 0x07> crc;
    crc.process_bytes(body.data(), body.size());
    return static_cast<std::uint8_t>(crc.checksum());
  }
  std::uint8_t sum = 0;
  for (const char c : body) sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
  return sum;
}

/// Removes the checksum from the line. @return whether it is right, or none is expected
bool take_checksum(std::string_view& line, LineChecksum kind) {
  const std::size_t star = line.rfind('*');
  if (star == std::string_view::npos || line.size() != star + 1 + kChecksumDigits)
    return kind == LineChecksum::none;
  const std::string_view digits = line.substr(star + 1);
  std::string_view body = line = line.substr(0, star);
  if (kind == LineChecksum::none) return true;
  if (body.starts_with('$')) body.remove_prefix(1);
  unsigned stated = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), stated, 16);
  return read.ec == std::errc() && read.ptr == digits.data() + digits.size() &&
         stated == checksum_of(body, kind);
}

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Takes the columns of a line from its front.
class Columns {
 public:
  Columns(std::string_view rest, const std::string& separators) : rest_(rest), separators_(separators) {}

  std::string_view next() {
    const std::size_t end = std::min(rest_.find_first_of(separators_), rest_.size());
    const std::string_view column = rest_.substr(0, end);
    rest_.remove_prefix(end);
    skip_separator();
    return column;
  }
  void skip_separator() {
    skip_blanks();
    if (!rest_.empty() && is_separator(rest_.front())) rest_.remove_prefix(1);
    skip_blanks();
  }
  bool at_end() const { return rest_.empty(); }

 private:
  bool is_separator(char c) const { return separators_.find(c) != std::string::npos; }
  void skip_blanks() {
    while (!rest_.empty() && is_blank(rest_.front()) && is_separator(rest_.front())) rest_.remove_prefix(1);
  }

  std::string_view rest_;
  const std::string& separators_;
};

template <class Number>
std::optional<Number> number_of(std::string_view column) {
  if (column.starts_with('+')) column.remove_prefix(1);
  Number value{};
  const auto read = std::from_chars(column.data(), column.data() + column.size(), value);
  if (read.ec != std::errc() || read.ptr != column.data() + column.size()) return {};
  return value;
}

/// [µs] modulo 2^32.
std::optional<std::uint32_t> time_of(std::string_view column, double unit) {
  constexpr double kLargest = 9e18;
  const auto value = number_of<double>(column);
  if (!value || !(std::abs(*value * unit * 1e6) < kLargest)) return {};
  return static_cast<std::uint32_t>(std::llround(*value * unit * 1e6));
}

}  // namespace

PlateFailure decode_encoder_line(std::string_view line, const EncoderLine& format, PlateReading& reading) {
  if (!line.starts_with(format.begin)) return PlateFailure::OtherSentence;
  if (!take_checksum(line, format.checksum)) return PlateFailure::BadChecksum;
  if (line.size() < format.begin.size()) return PlateFailure::Truncated;
  Columns columns(line.substr(format.begin.size()), format.separators);
  columns.skip_separator();
  std::optional<std::int64_t> count;
  std::optional<std::uint32_t> time;
  for (std::size_t i = 1; !columns.at_end(); ++i) {
    const std::string_view column = columns.next();
    if (i == format.count_column) count = number_of<std::int64_t>(column);
    if (i == format.time_column) time = time_of(column, format.time_unit);
  }
  if (!count || (format.time_column && !time)) return PlateFailure::BadField;
  reading.count = static_cast<std::uint32_t>(*count);
  if (time) reading.device_us = *time;
  return PlateFailure::None;
}

PlateFailure decode_plate_line(std::string_view line, const std::optional<EncoderLine>& own,
                               PlateReading& reading) {
  constexpr std::int64_t kNsInUs = 1000;
  if (!own || line.starts_with("$PPLT,")) return decode_plate_sentence(line, reading);
  if (line.size() > kLongestEncoderLine) return PlateFailure::Truncated;
  reading.device_us = static_cast<std::uint32_t>(reading.receipt_ns / kNsInUs);
  reading.numbered = false;
  return decode_encoder_line(line, *own, reading);
}

}  // namespace crisp::wire
