// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/pcap_records.hpp"

#include <cstdlib>

#include <crisp/error.hpp>

namespace crisp::capture {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000, kDay = 86'400 * kSecond;
constexpr std::uint32_t kMicroseconds = 0xa1b2c3d4, kNanoseconds = 0xa1b23c4d;
constexpr std::uint32_t kExtended =
    0xa1b2cd34;  // an old patch of libpcap: 8 more bytes in each record's header
constexpr std::uint32_t kLargestOriginal = 1 << 24;

}  // namespace

bool PcapRecords::recognises(wire::ByteView begin) {
  if (begin.size() < 4) return false;
  for (const auto order : {ByteOrder::Little, ByteOrder::Big}) {
    const auto magic = number_at<std::uint32_t>(begin, 0, order);
    if (magic == kMicroseconds || magic == kNanoseconds || magic == kExtended) return true;
  }
  return false;
}

PcapRecords::PcapRecords(FileWindow& file, Counts& losses) : file_(file), losses_(losses) {
  const auto begin = file_.peek(kPcapFileHeader);
  if (begin.size() < kPcapFileHeader) {
    throw Error(file.path().string() + " ends within its header",
                "the capture holds no packets: capture it again");
  }
  if (begin[0] == 0xa1) order_ = ByteOrder::Big;
  const auto magic = number_at<std::uint32_t>(begin, 0, order_);
  if (magic == kNanoseconds) ns_per_tick_ = 1;
  if (magic == kExtended) header_size_ = 24;
  link_type_ = number_at<std::uint32_t>(begin, 20, order_) & 0xFFFF;  // the rest describes frame checksums
  file_.skip(kPcapFileHeader);
}

std::optional<PcapRecords::Header> PcapRecords::header(wire::ByteView bytes) const {
  const auto field = [&](std::size_t at) { return number_at<std::uint32_t>(bytes, at, order_); };
  const auto ticks = field(4) * ns_per_tick_;
  const Header found{field(0) * kSecond + ticks, field(8), field(12)};
  if (ticks >= kSecond || found.captured > kLargestPacket || found.original > kLargestOriginal) return {};
  if (found.time_ns == 0 && found.original == 0) return {};  // zeros that a power cut left behind
  return found;
}

/// The header at `at`, if it is plausible for a packet less than a day away from near_ns.
std::optional<PcapRecords::Header> PcapRecords::believable_header(wire::ByteView bytes, std::size_t at,
                                                                  std::optional<std::int64_t> near_ns) const {
  if (at + header_size_ > bytes.size()) return {};
  const auto found = header(bytes.subspan(at));
  if (!found || found->captured == 0 || found->captured > found->original) return {};
  if (near_ns && std::abs(found->time_ns - *near_ns) >= kDay) return {};
  return found;
}

/// The first place from which two records follow each other, near in time to the last good one.
std::optional<std::size_t> PcapRecords::find_record(wire::ByteView bytes, std::size_t from) const {
  for (std::size_t at = from; at + header_size_ <= bytes.size(); ++at) {
    const auto first = believable_header(bytes, at, last_time_ns_);
    if (!first) continue;
    const auto second = at + header_size_ + first->captured;
    if (second == bytes.size() || believable_header(bytes, second, first->time_ns)) return at;
  }
  return {};
}

/// Moves on to the next believable record, at least `from` bytes from here.
bool PcapRecords::resynchronise(std::size_t from) {
  losses_.add(file_loss::kDamagedRecords);
  while (true) {
    const auto bytes = file_.peek(FileWindow::kLargestPeek);
    const auto found = find_record(bytes, from);
    const bool last = bytes.size() < FileWindow::kLargestPeek;
    const auto step = found ? *found : last ? bytes.size() : bytes.size() - kLargestPacket - 2 * header_size_;
    losses_.add(file_loss::kSkippedBytes, step);
    file_.skip(step);
    if (found) return true;
    if (last) return false;
    from = 0;
  }
}

bool PcapRecords::cut_off(std::size_t rest) {
  losses_.add(file_loss::kCutOff, rest);
  file_.skip(rest);
  return false;
}

bool PcapRecords::next(Packet& packet) {
  while (true) {
    const auto begin = file_.peek(header_size_);
    if (begin.size() < header_size_) return cut_off(begin.size());
    const auto found = header(begin);
    if (!found) {
      if (!resynchronise(1)) return false;
      continue;
    }
    const auto size = header_size_ + found->captured;
    auto bytes = file_.peek(size + header_size_);
    const bool whole = bytes.size() >= size;
    const bool good = believable_header(bytes, 0, last_time_ns_).has_value();
    const bool followed = bytes.size() == size || believable_header(bytes, size, found->time_ns);
    if (!good || !followed) {
      // Damaged is either this header (the next record then begins where this one should not be over, or
      // nothing fits at all) or the next one; or the file ends here, or nothing is wrong but a pause of days.
      bytes = file_.peek(FileWindow::kLargestPeek);
      const auto next_record = find_record(bytes, 1);
      if ((next_record && *next_record < size) || (!good && !followed)) {
        if (!resynchronise(1)) return false;
        continue;
      }
      if (!whole) return cut_off(bytes.size());
    }
    packet = {found->time_ns, link_type_, found->original, bytes.subspan(header_size_, found->captured)};
    last_time_ns_ = found->time_ns;
    file_.skip(size);
    return true;
  }
}

}  // namespace crisp::capture
