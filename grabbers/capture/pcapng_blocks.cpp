// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/pcapng_blocks.hpp"

#include <algorithm>

namespace crisp::capture {
namespace {

using wire::ByteView;

constexpr std::uint32_t kSection = 0x0A0D0D0A, kInterface = 1, kObsoletePacket = 2, kSimplePacket = 3;
constexpr std::uint32_t kStatistics = 5, kPacket = 6;
constexpr std::uint32_t kByteOrderMark = 0x1A2B3C4D;
constexpr std::size_t kHeader = 8, kFrame = 12;  // type and length; with the length again at the end
constexpr std::uint32_t kLargestBlock = 16 << 20;

std::size_t padded(std::size_t n) { return (n + 3) / 4 * 4; }

bool has_packet(std::uint32_t type) {
  return type == kPacket || type == kObsoletePacket || type == kSimplePacket;
}

/// Packets, and the blocks needed to interpret them.
bool is_of_use(std::uint32_t type) { return has_packet(type) || type == kInterface || type == kStatistics; }

/// Kinds without packets: names, journal entries, secrets, custom blocks.
bool may_be_skipped(std::uint32_t type) {
  return type == kSection || type == 4 || type == 9 || type == 0xA || type == 0xBAD || type == 0x40000BAD;
}

std::optional<ByteOrder> section_order(ByteView begin) {
  if (begin.size() < kFrame) return {};
  for (const auto order : {ByteOrder::Little, ByteOrder::Big}) {
    if (number_at<std::uint32_t>(begin, 8, order) == kByteOrderMark) return order;
  }
  return {};
}

}  // namespace

bool PcapngBlocks::recognises(ByteView begin) {
  return begin.size() >= 4 && number_at<std::uint32_t>(begin, 0, ByteOrder::Little) == kSection;
}

/// Options are pairs of code and length, each padded to 32 bits; 0 ends them.
template <class Take>
void PcapngBlocks::options(ByteView bytes, Take take) const {
  while (bytes.size() >= 4) {
    const auto code = number_at<std::uint16_t>(bytes, 0, order_),
               length = number_at<std::uint16_t>(bytes, 2, order_);
    if (code == 0 || bytes.size() < std::size_t{4} + length) return;
    take(code, bytes.subspan(4, length));
    bytes = bytes.subspan(std::min(bytes.size(), 4 + padded(length)));
  }
}

/// The length of the block that begins here, if it can be one. @param begin at least kHeader bytes
std::optional<std::size_t> PcapngBlocks::block_size(ByteView begin) const {
  const std::size_t size = u32(begin, 4);
  if (size < kFrame || size > kLargestBlock || size % 4 != 0) return {};
  return size;
}

/// Whether a block of a kind that is worth finding lies at `at`, whole, with its length at both ends.
bool PcapngBlocks::is_block(ByteView bytes, std::size_t at) const {
  const auto block = bytes.subspan(at);
  if (block.size() < kFrame) return false;
  if (recognises(block)) return section_order(block).has_value();
  const auto size = block_size(block);
  const auto type = u32(block, 0);
  return is_of_use(type) && size && *size <= block.size() && u32(block, *size - 4) == *size;
}

bool PcapngBlocks::resynchronise() {
  losses_.add(file_loss::kDamagedRecords);
  std::size_t from = 4;
  while (true) {
    const auto bytes = file_.peek(FileWindow::kLargestPeek);
    std::size_t at = from;
    while (at < bytes.size() && !is_block(bytes, at)) at += 4;  // all blocks are a multiple of 4 bytes long
    const bool found = at < bytes.size();
    const bool last = bytes.size() < FileWindow::kLargestPeek;
    const auto step = found ? at : last ? bytes.size() : bytes.size() - 2 * kLargestPacket;
    losses_.add(file_loss::kSkippedBytes, step);
    file_.skip(step);
    if (found || last) return found;
    from = 0;
  }
}

bool PcapngBlocks::enter_section(ByteView begin) {
  const auto order = section_order(begin);
  if (!order) return false;
  order_ = *order;
  interfaces_.clear();
  return true;
}

std::optional<ByteView> PcapngBlocks::next_block() {
  while (true) {
    const auto begin = file_.peek(kFrame);
    if (begin.empty()) return {};
    if (begin.size() < kFrame) {
      losses_.add(file_loss::kCutOff, begin.size());
      return {};
    }
    const bool sane = !recognises(begin) || enter_section(begin);
    auto size = sane ? block_size(begin) : std::nullopt;
    if (size && *size > FileWindow::kLargestPeek) {
      if (!is_of_use(u32(begin, 0))) {  // secrets, names …
        file_.skip(*size);
        continue;
      }
      size.reset();  // no packet is that long
    }
    const auto block = size ? file_.peek(*size) : ByteView();
    const bool whole = size && block.size() == *size;
    if (whole && u32(block, *size - 4) == *size) {
      file_.skip(*size);
      return block;
    }
    if (size && !whole && !holds_a_block(block)) {  // the file ends here
      losses_.add(file_loss::kCutOff, block.size());
      return {};
    }
    if (!resynchronise()) return {};
  }
}

bool PcapngBlocks::holds_a_block(ByteView bytes) const {
  for (std::size_t at = 4; at < bytes.size(); at += 4) {
    if (is_block(bytes, at)) return true;
  }
  return false;
}

bool PcapngBlocks::next(Packet& packet) {
  while (const auto block = next_block()) {
    const auto type = u32(*block, 0);
    const auto body = block->subspan(kHeader, block->size() - kFrame);
    if (type == kInterface) describe_interface(body);
    if (type == kStatistics) read_statistics(body);
    if (has_packet(type) && read_packet(type, body, packet)) return true;
    if (!is_of_use(type) && !may_be_skipped(type)) losses_.add(file_loss::kUnknownBlocks);
  }
  return false;
}

void PcapngBlocks::describe_interface(ByteView body) {
  Interface described;
  if (body.size() >= 8) {
    described.link_type = number_at<std::uint16_t>(body, 0, order_);
    options(body.subspan(8), [&](std::uint16_t code, ByteView value) {
      constexpr std::uint16_t kResolution = 9, kOffset = 14;
      if (code == kResolution && value.size() == 1) described.resolution = value[0];
      if (code == kOffset && value.size() == 8) {
        described.offset_s = static_cast<std::int64_t>(number_at<std::uint64_t>(value, 0, order_));
      }
    });
  }
  interfaces_.push_back(described);
}

void PcapngBlocks::read_statistics(ByteView body) {
  if (body.size() < 12 || u32(body, 0) >= interfaces_.size()) return;
  auto& dropped = interfaces_[u32(body, 0)].dropped;
  options(body.subspan(12), [&](std::uint16_t code, ByteView value) {
    constexpr std::uint16_t kInterfaceDropped = 5, kSystemDropped = 7;
    if ((code != kInterfaceDropped && code != kSystemDropped) || value.size() != 8) return;
    const auto total = number_at<std::uint64_t>(value, 0, order_);
    if (total > dropped) losses_.add(file_loss::kNotCaptured, total - dropped);
    dropped = std::max(dropped, total);
  });
}

bool PcapngBlocks::read_packet(std::uint32_t type, ByteView body, Packet& packet) {
  constexpr std::size_t kFields = 20;
  if (type == kSimplePacket) {
    losses_.add(file_loss::kNoStamp);
    return false;
  }
  if (body.size() < kFields) {
    losses_.add(file_loss::kDamagedRecords);
    return false;
  }
  const std::uint32_t interface = type == kPacket ? u32(body, 0) : number_at<std::uint16_t>(body, 0, order_);
  const std::size_t captured = u32(body, 12);
  if (captured > body.size() - kFields) {
    losses_.add(file_loss::kDamagedRecords);
    return false;
  }
  if (interface >= interfaces_.size()) {
    losses_.add(file_loss::kUnknownInterface);
    return false;
  }
  const auto ticks = std::uint64_t{u32(body, 4)} << 32 | u32(body, 8);
  const auto time = to_ns(ticks, interfaces_[interface]);
  if (!time) {
    losses_.add(file_loss::kDamagedStamps);
    return false;
  }
  packet = {*time, interfaces_[interface].link_type, u32(body, 16), body.subspan(kFields, captured)};
  return true;
}

/// Nothing for times beyond what 64 bits of nanoseconds hold.
std::optional<std::int64_t> PcapngBlocks::to_ns(std::uint64_t ticks, const Interface& interface) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  const unsigned n = interface.resolution & 0x7F;
  std::uint64_t seconds = 0, ns = 0;
  if ((interface.resolution & 0x80) != 0) {
    if (n > 63) return {};
    seconds = ticks >> n;
    const auto fraction = ticks & ((std::uint64_t{1} << n) - 1);
    constexpr unsigned kBitsThatFit = 34;  // 2^34 · 10^9 < 2^64
    const unsigned drop = n > kBitsThatFit ? n - kBitsThatFit : 0;
    ns = ((fraction >> drop) * kSecond) >> (n - drop);
  } else {
    if (n > 19) return {};
    std::uint64_t per_second = 1;
    for (unsigned i = 0; i < n; ++i) per_second *= 10;
    seconds = ticks / per_second;
    auto fraction = ticks % per_second;
    for (unsigned i = n; i < 9; ++i) fraction *= 10;
    for (unsigned i = 9; i < n; ++i) fraction /= 10;
    ns = fraction;
  }
  constexpr std::int64_t kMaxSeconds = 9'223'372'034;  // a second more still fits
  const bool fits = seconds <= static_cast<std::uint64_t>(kMaxSeconds) && interface.offset_s <= kMaxSeconds &&
                    interface.offset_s >= -kMaxSeconds;
  const auto total = fits ? static_cast<std::int64_t>(seconds) + interface.offset_s : -1;
  if (total < 0 || total > kMaxSeconds) return {};
  return total * static_cast<std::int64_t>(kSecond) + static_cast<std::int64_t>(ns);
}

}  // namespace crisp::capture
