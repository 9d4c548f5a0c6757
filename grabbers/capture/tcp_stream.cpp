// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/tcp_stream.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>

namespace crisp::capture {
namespace {

constexpr std::int64_t kWindow = 1 << 20;  // [bytes] largest plausible distance of a segment from its stream
constexpr std::int64_t kLastTry = 130'000'000'000;  // [ns] an unanswered handshake is repeated for 127 s
constexpr std::size_t kMaxHeld = 4 << 20, kMaxSegments = 4096;

}  // namespace

void TcpStream::take(const devices::TransportPacket& segment, std::int64_t time_ns) {
  expire(time_ns);
  const auto sequence = segment.sequence + (segment.syn ? 1 : 0);
  if (segment.syn && !is_handshake_again(sequence, time_ns)) begin(sequence, time_ns);
  if (!segment.payload.empty() || segment.missing > 0) {
    if (!begun_) begin(sequence, time_ns);
    place(sequence, segment.payload, segment.missing, time_ns);
  }
  if (segment.reset) finish();
  over_ = over_ || segment.fin || segment.reset;
}

/// Whether this begin is that of the present connection, sent or captured again. Another connection may begin
/// with the same number: then the one before is over, or this comes later than a repetition would.
bool TcpStream::is_handshake_again(std::uint32_t sequence, std::int64_t time_ns) const {
  if (!begun_ || over_ || sequence != first_) return false;
  const bool answered = position_ > 0 || !held_.empty();
  return time_ns - begun_ns_ <= (answered ? max_wait_ns_ : kLastTry);
}

void TcpStream::begin(std::uint32_t sequence, std::int64_t time_ns) {
  if (begun_) {
    finish();
    sink_.gap();
  }
  begun_ = true;
  begun_ns_ = time_ns;
  over_ = false;
  first_ = sequence;
  position_ = 0;
  ++counts_.connections;
}

void TcpStream::place(std::uint32_t sequence, wire::ByteView bytes, std::uint32_t missing,
                      std::int64_t time_ns) {
  const auto expected = static_cast<std::uint32_t>(first_ + position_);
  const std::int64_t distance = static_cast<std::int32_t>(sequence - expected);
  if (std::abs(distance) > kWindow) {
    if (!continues_held_segment(sequence, bytes, time_ns)) return;
    return place(sequence, bytes, missing, time_ns);
  }
  const auto size = static_cast<std::int64_t>(bytes.size());
  if (distance + size + missing <= 0) {
    ++counts_.repeated_segments;
    sink_.repeated(bytes);
    return;
  }
  if (distance > 0) {
    const auto offset = position_ + static_cast<std::uint64_t>(distance);
    const bool is_overtaken = !held_.empty() && held_.rbegin()->first > offset;
    const auto before = held_bytes_;
    hold(offset, bytes, time_ns);
    if (held_bytes_ == before)
      ++counts_.repeated_segments;
    else if (is_overtaken)
      ++counts_.late_segments;
    while (held_bytes_ > kMaxHeld || held_.size() > kMaxSegments) skip_hole();
    return;
  }
  const auto end = position_ + static_cast<std::uint64_t>(distance + size + missing);
  bytes = bytes.subspan(static_cast<std::size_t>(std::min(-distance, size)));
  if (held_.empty()) {
    deliver(bytes, time_ns);
  } else {  // some of these bytes may have come before
    hold(position_, bytes, time_ns);
    ++counts_.late_segments;
    release();
  }
  if (position_ < end) {  // the capture cut the segment short: nobody will send the rest again
    jump_to(end);
    release();
  }
}

void TcpStream::deliver(wire::ByteView bytes, std::int64_t arrival_ns) {
  position_ += bytes.size();
  if (!bytes.empty()) sink_.data(bytes, arrival_ns);
}

/// Keeps those of the bytes that are not held already.
void TcpStream::hold(std::uint64_t offset, wire::ByteView bytes, std::int64_t time_ns) {
  while (!bytes.empty()) {
    const auto next = held_.upper_bound(offset);
    const auto end_before =
        next == held_.begin() ? 0 : std::prev(next)->first + std::prev(next)->second.bytes.size();
    auto size = bytes.size();
    if (end_before > offset) {
      size = std::min<std::uint64_t>(size, end_before - offset);
    } else {
      if (next != held_.end()) size = std::min<std::uint64_t>(size, next->first - offset);
      held_.emplace_hint(
          next, offset,
          Held{wire::Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)), time_ns});
      held_bytes_ += size;
    }
    offset += size;
    bytes = bytes.subspan(size);
  }
}

/// Delivers what was held and is no longer behind a hole.
void TcpStream::release() {
  while (!held_.empty() && held_.begin()->first <= position_) {
    const auto node = held_.extract(held_.begin());
    const auto& held = node.mapped();
    held_bytes_ -= held.bytes.size();
    const auto known = std::min<std::uint64_t>(position_ - node.key(), held.bytes.size());
    deliver(wire::ByteView(held.bytes).subspan(known), held.arrival_ns);
  }
}

void TcpStream::jump_to(std::uint64_t offset) {
  ++counts_.holes;
  counts_.lost_bytes += offset - position_;
  position_ = offset;
  sink_.gap();
}

void TcpStream::expire(std::int64_t now_ns) {
  while (!held_.empty() && now_ns - *oldest_held() > max_wait_ns_) skip_hole();
  if (held_segment_ && now_ns - held_segment_->arrival_ns > max_wait_ns_) drop_held_segment();
}

void TcpStream::finish() {
  while (!held_.empty()) skip_hole();
  drop_held_segment();
}

void TcpStream::skip_hole() {
  jump_to(held_.begin()->first);
  release();
}

void TcpStream::drop_held_segment() {
  if (held_segment_) ++counts_.out_of_window;
  held_segment_.reset();
}

std::optional<std::int64_t> TcpStream::oldest_held() const {
  std::optional<std::int64_t> oldest;
  for (const auto& [offset, held] : held_)
    oldest = std::min(oldest.value_or(held.arrival_ns), held.arrival_ns);
  return oldest;
}

std::optional<std::int64_t> TcpStream::oldest_waiting() const {
  const auto oldest = oldest_held();
  if (!held_segment_) return oldest;
  return std::min(oldest.value_or(held_segment_->arrival_ns), held_segment_->arrival_ns);
}

/// Whether the stream continues from the out-of-window segment held before, which this one follows: a new
/// connection.
bool TcpStream::continues_held_segment(std::uint32_t sequence, wire::ByteView bytes, std::int64_t time_ns) {
  const bool continues = held_segment_ && sequence == static_cast<std::uint32_t>(held_segment_->sequence +
                                                                                 held_segment_->bytes.size());
  if (continues) {
    const auto before = std::move(*held_segment_);
    held_segment_.reset();
    begin(before.sequence, before.arrival_ns);
    deliver(before.bytes, before.arrival_ns);
    return true;
  }
  drop_held_segment();
  held_segment_ = HeldSegment{sequence, wire::Bytes(bytes.begin(), bytes.end()), time_ns};
  return false;
}

}  // namespace crisp::capture
