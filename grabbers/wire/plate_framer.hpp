// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "grabbers/wire/bytes.hpp"
#include "grabbers/wire/encoder_line.hpp"
#include "grabbers/wire/plate_sentence.hpp"

namespace crisp::wire {

/// What cuts a plate's bytes into pieces.
enum class PlateBytes : std::uint8_t {
  stream,    ///< TCP or a serial line: it may begin within a line
  datagrams  ///< each begins with a line, and ends its last
};

/// Finds the plate's sentences in a stream of bytes (datagrams, a serial line, TCP) that is cut anywhere and
/// may be damaged. A sentence begins with `$` and ends with a line feed; everything else is skipped and
/// counted. Memory is bounded by one line.
///
/// With a format of the user's own each line is read by it, and sentences all the same.
class PlateFramer {
 public:
  explicit PlateFramer(std::optional<EncoderLine> own = {}, PlateBytes bytes = PlateBytes::stream)
      : own_(std::move(own)), bytes_(bytes), within_line_(bytes == PlateBytes::stream) {}

  struct Counts {
    std::uint64_t readings = 0;
    std::array<std::uint64_t, 5> failures{};  ///< lines that are no reading, by PlateFailure
    std::uint64_t skipped_bytes = 0;          ///< bytes outside of any sentence
    /// Whether anything came that was no reading.
    bool any_damage() const {
      return skipped_bytes > 0 || std::ranges::any_of(failures, [](auto n) { return n > 0; });
    }
    std::uint64_t of(PlateFailure failure) const { return failures[static_cast<std::size_t>(failure)]; }
  };

  /// Parses the next bytes and calls `sink(const PlateReading&)` for each reading that they complete.
  /// @param arrival_ns [ns] hub time at which these bytes arrived: the reading's receipt time
  template <class Sink>
  void feed(ByteView bytes, std::int64_t arrival_ns, Sink&& sink) {
    if (own_) return feed_lines(bytes, arrival_ns, sink);
    while (!bytes.empty()) {
      const auto byte = bytes.front();
      latest_ns_ = line_.empty() || byte == '$' ? arrival_ns : std::max(latest_ns_, arrival_ns);
      const auto inside = lengthen(bytes);
      if (inside == 0) {
        if (const auto reading = take(static_cast<char>(byte))) sink(*reading);
      }
      bytes = bytes.subspan(std::max<std::size_t>(inside, 1));
    }
  }

  /// Marks missing bytes, or the end of the datagram or stream, and calls `sink` for a reading that ends
  /// there.
  template <class Sink>
  void gap(Sink&& sink) {
    if (own_ && bytes_ == PlateBytes::datagrams) {
      if (const auto reading = finish_own_line()) sink(*reading);
    }
    gap();
  }
  void gap();

  const Counts& counts() const { return counts_; }
  /// Counts begin at zero again.
  Counts take_counts() { return std::exchange(counts_, {}); }

  /// Whether the begin of a sentence waits for its end.
  bool waiting() const { return !line_.empty(); }

 private:
  template <class Sink>
  void feed_lines(ByteView bytes, std::int64_t arrival_ns, Sink& sink) {
    for (const auto byte : bytes) {
      latest_ns_ = line_.empty() ? arrival_ns : std::max(latest_ns_, arrival_ns);
      if (byte != '\n') {
        if (line_.size() <= kLongestEncoderLine) line_ += static_cast<char>(byte);
      } else if (const auto reading = finish_own_line()) {
        sink(*reading);
      }
    }
  }

  std::size_t lengthen(ByteView bytes);
  std::optional<PlateReading> take(char c);
  std::optional<PlateReading> end_line(PlateFailure failure, const PlateReading& reading);
  std::optional<PlateReading> finish_line();
  std::optional<PlateReading> finish_own_line();

  std::optional<EncoderLine> own_;
  PlateBytes bytes_;
  bool within_line_;             ///< the next bytes may be the end of a line whose begin is missing
  std::uint16_t own_lines_ = 0;  ///< read so far
  std::string line_;             ///< from its begin on; empty between sentences
  std::int64_t latest_ns_ = 0;
  Counts counts_;
};

}  // namespace crisp::wire
