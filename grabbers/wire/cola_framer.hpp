// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "grabbers/wire/cola.hpp"

namespace crisp::wire {

/// One whole telegram of a byte stream.
struct ColaFrame {
  ColaLanguage language = ColaLanguage::B;
  ByteView payload;               ///< without framing
  std::int64_t completed_ns = 0;  ///< arrival of the packet that completed it: the latest of its bytes'
};

/// Finds CoLa-A and CoLa-B telegrams in a byte stream that is cut anywhere, may begin inside a telegram and
/// may be damaged. A telegram is accepted only whole: with its end (A) or its checksum (B); after a false
/// start the search goes on from the next byte. The result does not depend on how the stream was cut into
/// pieces. Memory is bounded by one largest telegram and one piece.
class ColaFramer {
 public:
  struct Counts {
    std::uint64_t telegrams = 0;
    std::uint64_t skipped_bytes = 0;       ///< bytes outside of whole telegrams
    std::uint64_t resynchronisations = 0;  ///< telegrams found behind skipped bytes
    std::uint64_t checksum_failures = 0;   ///< CoLa-B telegrams refused for their checksum
    std::uint64_t cut = 0;                 ///< telegrams whose rest was missing at a gap or at the end
  };

  /// Parses the next bytes and calls `sink(const ColaFrame&)` for each telegram that they complete; the
  /// frame's payload is valid during the call.
  /// @param arrival_ns [ns] hub time at which these bytes arrived
  template <class Sink>
  void feed(ByteView bytes, std::int64_t arrival_ns, Sink&& sink) {
    append(bytes, arrival_ns);
    while (const auto frame = next(false)) sink(*frame);
  }

  /// Marks missing bytes, or the stream's end: incomplete telegrams are given up. Calls `sink` for telegrams
  /// that a false start had hidden.
  template <class Sink>
  void gap(Sink&& sink) {
    while (const auto frame = next(true)) sink(*frame);
  }

  const Counts& counts() const { return counts_; }

  /// [ns] Arrival of the oldest byte that waits for its telegram's end: no telegram still to be found was
  /// completed earlier. Nothing if no byte waits.
  std::optional<std::int64_t> waiting_since() const {
    return pieces_.empty() ? std::nullopt : std::optional(oldest_piece());
  }

 private:
  struct Piece {            ///< bytes that arrived together
    std::uint64_t end = 0;  ///< offset in the stream
    std::int64_t arrival_ns = 0;
  };

  std::int64_t oldest_piece() const;
  void append(ByteView bytes, std::int64_t arrival_ns);
  std::optional<ColaFrame> next(bool ended);
  ColaFrame take(ByteView payload, ColaLanguage language, std::size_t frame_size);
  void skip(std::size_t n);
  void advance(std::size_t n);
  ByteView waiting() const { return ByteView(buffer_).subspan(begin_); }

  Bytes buffer_;
  std::size_t begin_ = 0;     ///< of what waits, in the buffer
  std::uint64_t offset_ = 0;  ///< of what waits, in the stream
  std::deque<Piece> pieces_;  ///< of what waits
  bool in_step_ = true;       ///< no byte was skipped since the last telegram
  Counts counts_;
};

}  // namespace crisp::wire
