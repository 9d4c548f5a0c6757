// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/encoder_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grabbers/table/decimal.hpp"
#include "grabbers/wire/encoder_line.hpp"

namespace crisp::table {
namespace {

constexpr std::string_view kBlanks = " \t";

std::string_view without_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

}  // namespace

/// Takes the time of receipt from the front of a line. @return whether there is one
bool EncoderLines::take_stamp(std::string_view& line, PlateReading& reading) const {
  const std::size_t end = std::min(line.find_first_of(",; \t"), line.size());
  const auto receipt_ns = shifted_decimal(line.substr(0, end), exponent_of(*stamp_));
  if (!receipt_ns || end == line.size()) return false;
  reading.receipt_ns = *receipt_ns;
  line = without_blanks(line.substr(end + 1));
  return true;
}

/// Uses a line's own time for its receipt. @return whether it is later than the line before
bool EncoderLines::take_own_time(PlateReading& reading) {
  constexpr std::uint32_t kHalf = 1U << 31;
  constexpr std::int64_t kNsInUs = 1000;
  if (last_us_) {
    const std::uint32_t step = reading.device_us - static_cast<std::uint32_t>(*last_us_);
    if (step == 0 || step >= kHalf) return false;
    *last_us_ += step;
  } else {
    last_us_ = reading.device_us;
  }
  reading.receipt_ns = kNsInUs * *last_us_;
  return true;
}

void EncoderLines::note_fault(std::string what) {
  ++losses_[what];
  if (!first_fault_) first_fault_.emplace(std::move(what), "", Place{name_, lines_.number(), 1});
}

std::optional<PlateReading> EncoderLines::next() {
  std::string text;
  while (lines_.next(text)) {
    std::string_view line = without_blanks(text);
    if (line.empty()) continue;
    PlateReading reading{.sequence = static_cast<std::uint16_t>(readings_)};
    if (stamp_ && !take_stamp(line, reading)) {
      note_fault("lines without a time of receipt");
      continue;
    }
    const wire::PlateFailure failure = wire::decode_plate_line(line, own_, reading);
    if (failure == wire::PlateFailure::OtherSentence) {
      ++losses_["lines that are not of the encoder"];
    } else if (failure != wire::PlateFailure::None) {
      note_fault(fmt::format("lines with {}", wire::to_string(failure)));
    } else if (!stamp_ && !take_own_time(reading)) {
      note_fault("lines that are not later than the one before");
    } else {
      ++readings_;
      return reading;
    }
  }
  return {};
}

}  // namespace crisp::table
