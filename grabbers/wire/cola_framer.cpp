// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/cola_framer.hpp"

#include <algorithm>

#include "grabbers/wire/binary_fields.hpp"

namespace crisp::wire {
namespace {

constexpr std::uint8_t kStart = 0x02, kEnd = 0x03;
constexpr std::size_t kHeaderB = 8;          // 02 02 02 02 and the length
constexpr std::size_t kSmallestPayload = 4;  // "sFA" and a code, "sRN X": nothing shorter is a telegram

enum class Verdict : std::uint8_t { Whole, Incomplete, NoTelegram, BadChecksum };

/// Candidate telegram at a byte of the stream.
struct Candidate {
  Verdict verdict = Verdict::NoTelegram;
  ColaLanguage language = ColaLanguage::B;
  std::size_t payload_begin = 0, payload_size = 0, frame_size = 0;
};

/// Whether the bytes, as many as there are, can be the begin of a payload: "sRA", "sFA" …
bool begins_like_a_command(ByteView payload) {
  const auto upper = [](std::uint8_t c) { return c >= 'A' && c <= 'Z'; };
  return (payload.empty() || payload[0] == 's') && (payload.size() < 2 || upper(payload[1])) &&
         (payload.size() < 3 || upper(payload[2]));
}

Candidate examine_a(ByteView bytes) {
  const auto text = bytes.subspan(1);
  if (!begins_like_a_command(text.first(std::min<std::size_t>(text.size(), 3)))) return {};
  const auto end = std::find_if(text.begin(), text.end(), [](std::uint8_t c) { return c < ' '; });
  const auto size = static_cast<std::size_t>(end - text.begin());
  if (size > kLargestColaPayload) return {};
  if (end == text.end()) return {.verdict = Verdict::Incomplete};
  if (*end != kEnd || size < kSmallestPayload) return {};
  return {Verdict::Whole, ColaLanguage::A, 1, size, size + 2};
}

Candidate examine_b(ByteView bytes) {
  if (bytes.size() < kHeaderB) return {.verdict = Verdict::Incomplete};
  std::uint32_t size = 0;
  BinaryReader(bytes.subspan(4)).number(size);
  if (size < kSmallestPayload || size > kLargestColaPayload) return {};
  const auto rest = bytes.subspan(kHeaderB);
  if (!begins_like_a_command(rest.first(std::min<std::size_t>(rest.size(), 3)))) return {};
  if (rest.size() < size + 1) return {.verdict = Verdict::Incomplete};
  const bool good = cola_checksum(rest.first(size)) == rest[size];
  return {good ? Verdict::Whole : Verdict::BadChecksum, ColaLanguage::B, kHeaderB, size, kHeaderB + size + 1};
}

/// @param bytes not empty, begins with kStart
Candidate examine(ByteView bytes) {
  if (bytes.size() == 1) return {.verdict = Verdict::Incomplete};
  if (bytes[1] != kStart) return examine_a(bytes);
  const auto mark = bytes.first(std::min<std::size_t>(bytes.size(), 4));
  if (std::count(mark.begin(), mark.end(), kStart) != static_cast<std::ptrdiff_t>(mark.size())) return {};
  return examine_b(bytes);
}

}  // namespace

std::int64_t ColaFramer::oldest_piece() const {
  const auto earlier = [](const Piece& a, const Piece& b) { return a.arrival_ns < b.arrival_ns; };
  return std::min_element(pieces_.begin(), pieces_.end(), earlier)->arrival_ns;
}

void ColaFramer::append(ByteView bytes, std::int64_t arrival_ns) {
  if (bytes.empty()) return;
  if (begin_ > 0) {
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
    begin_ = 0;
  }
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  pieces_.push_back({offset_ + buffer_.size(), arrival_ns});
}

std::optional<ColaFrame> ColaFramer::next(bool ended) {
  bool cut = false;
  while (begin_ < buffer_.size()) {
    const auto bytes = waiting();
    if (bytes[0] != kStart) {
      skip(static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), kStart) - bytes.begin()));
      continue;
    }
    const auto found = examine(bytes);
    if (found.verdict == Verdict::Whole) {
      return take(bytes.subspan(found.payload_begin, found.payload_size), found.language, found.frame_size);
    }
    if (found.verdict == Verdict::Incomplete) {
      if (!ended) return {};
      cut = true;
    }
    if (found.verdict == Verdict::BadChecksum) ++counts_.checksum_failures;
    skip(1);
  }
  if (cut) ++counts_.cut;
  return {};
}

ColaFrame ColaFramer::take(ByteView payload, ColaLanguage language, std::size_t frame_size) {
  ColaFrame frame{.language = language, .payload = payload, .completed_ns = pieces_.front().arrival_ns};
  const auto end = offset_ + frame_size;
  for (const auto& piece : pieces_) {
    frame.completed_ns = std::max(frame.completed_ns, piece.arrival_ns);
    if (piece.end >= end) break;
  }
  advance(frame_size);
  ++counts_.telegrams;
  if (!in_step_) ++counts_.resynchronisations;
  in_step_ = true;
  return frame;
}

void ColaFramer::skip(std::size_t n) {
  advance(n);
  counts_.skipped_bytes += n;
  in_step_ = false;
}

void ColaFramer::advance(std::size_t n) {
  begin_ += n;
  offset_ += n;
  while (!pieces_.empty() && pieces_.front().end <= offset_) pieces_.pop_front();
}

}  // namespace crisp::wire
