// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/plate_framer.hpp"

namespace crisp::wire {

void PlateFramer::gap() {
  if (!line_.empty()) ++counts_.failures[static_cast<std::size_t>(PlateFailure::Truncated)];
  line_.clear();
  within_line_ = bytes_ == PlateBytes::stream;
}

/// Consumes the bytes that are within a sentence and do not end it; returns their number.
std::size_t PlateFramer::lengthen(ByteView bytes) {
  if (line_.empty() || line_.size() > kLongestPlateSentence) return 0;
  const auto room = bytes.first(std::min(bytes.size(), kLongestPlateSentence + 1 - line_.size()));
  const auto end =
      std::find_if(room.begin(), room.end(), [](auto byte) { return byte == '$' || byte == '\n'; });
  line_.append(room.begin(), end);
  return static_cast<std::size_t>(end - room.begin());
}

std::optional<PlateReading> PlateFramer::take(char c) {
  if (c == '$') {
    gap();  // of a sentence that lost its end
    line_ = "$";
    return {};
  }
  if (line_.empty()) {
    if (c != '\r' && c != '\n') ++counts_.skipped_bytes;
    return {};
  }
  if (c == '\n') return finish_line();
  if (line_.size() > kLongestPlateSentence) {
    gap();
    return {};
  }
  line_ += c;
  return {};
}

/// Ends a line, and counts it as a reading or by why it is none.
std::optional<PlateReading> PlateFramer::end_line(PlateFailure failure, const PlateReading& reading) {
  line_.clear();
  if (failure != PlateFailure::None) {
    ++counts_.failures[static_cast<std::size_t>(failure)];
    return {};
  }
  ++counts_.readings;
  return reading;
}

std::optional<PlateReading> PlateFramer::finish_line() {
  if (line_.back() == '\r') line_.pop_back();
  PlateReading reading{.receipt_ns = latest_ns_};
  const auto failure = decode_plate_sentence(line_, reading);
  return end_line(failure, reading);
}

std::optional<PlateReading> PlateFramer::finish_own_line() {
  const bool begins = !own_->begin.empty() && line_.starts_with(own_->begin);
  if (std::exchange(within_line_, false) && !begins) {
    counts_.skipped_bytes += line_.size();
    line_.clear();
  }
  if (line_.ends_with('\r')) line_.pop_back();
  if (line_.empty()) return {};
  PlateReading reading{.sequence = own_lines_, .receipt_ns = latest_ns_};
  const PlateFailure failure = decode_plate_line(line_, own_, reading);
  own_lines_ = static_cast<std::uint16_t>(own_lines_ + (failure == PlateFailure::None && !reading.numbered));
  return end_line(failure, reading);
}

}  // namespace crisp::wire
