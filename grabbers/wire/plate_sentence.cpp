// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/plate_sentence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>

namespace crisp::wire {
namespace {

constexpr std::string_view kTalker = "PPLT,";
constexpr std::size_t kChecksumEnd = 3;  // "*04"
constexpr std::string_view kHexDigits = "0123456789ABCDEF";

std::uint8_t checksum(std::string_view body) {
  return std::accumulate(body.begin(), body.end(), std::uint8_t{0},
                         [](std::uint8_t sum, char c) { return static_cast<std::uint8_t>(sum ^ c); });
}

/// Parses one decimal field at the front of `fields`.
template <class Number>
bool take(std::string_view& fields, Number& value) {
  const auto* end = fields.data() + fields.size();
  const auto [stop, error] = std::from_chars(fields.data(), end, value);
  if (error != std::errc() || (stop != end && *stop != ',')) return false;
  fields.remove_prefix(static_cast<std::size_t>(stop - fields.data()));
  if (!fields.empty()) fields.remove_prefix(1);
  return true;
}

}  // namespace

std::string_view to_string(PlateFailure failure) {
  switch (failure) {
    case PlateFailure::None:
      return "none";
    case PlateFailure::OtherSentence:
      return "another kind of sentence";
    case PlateFailure::Truncated:
      return "a truncated line";
    case PlateFailure::BadChecksum:
      return "a wrong checksum";
    case PlateFailure::BadField:
      return "a field that is missing or out of range";
  }
  return "unknown";
}

PlateFailure decode_plate_sentence(std::string_view line, PlateReading& reading) {
  if (line.size() < 1 + kChecksumEnd || line.front() != '$' || line[line.size() - kChecksumEnd] != '*') {
    return PlateFailure::Truncated;
  }
  auto body = line.substr(1, line.size() - 1 - kChecksumEnd);
  const unsigned sum = checksum(body);
  if (line[line.size() - 2] != kHexDigits[sum / 16] || line.back() != kHexDigits[sum % 16]) {
    return PlateFailure::BadChecksum;
  }
  if (!body.starts_with(kTalker)) return PlateFailure::OtherSentence;
  body.remove_prefix(kTalker.size());
  std::uint16_t sequence = 0;
  std::uint32_t device_us = 0, count = 0;
  const bool good = std::count(body.begin(), body.end(), ',') == 2 && take(body, sequence) &&
                    take(body, device_us) && take(body, count) && body.empty();
  if (!good) return PlateFailure::BadField;
  reading.sequence = sequence;
  reading.device_us = device_us;
  reading.count = count;
  return PlateFailure::None;
}

std::string encode_plate_sentence(const PlateReading& reading) {
  const auto body = fmt::format("{}{},{},{}", kTalker, reading.sequence, reading.device_us, reading.count);
  return fmt::format("${}*{:02X}\r\n", body, checksum(body));
}

}  // namespace crisp::wire
