// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/fragments.hpp"

#include <algorithm>

namespace crisp::capture {
namespace {

constexpr std::size_t kMaxPackets = 64, kMaxPieces = 8192;  // 65535 bytes in pieces of 8
constexpr std::uint32_t kLargestPayload = 65535;
constexpr std::int64_t kLongest = 30'000'000'000;

}  // namespace

std::optional<devices::IpPacket> FragmentAssembler::take(const devices::IpPacket& fragment,
                                                         std::int64_t time_ns) {
  forget_old(time_ns);
  const auto end = fragment.fragment_offset + fragment.payload.size();
  if (fragment.missing > 0 || end > kLargestPayload) {
    losses_.add(kIncomplete);
    return {};
  }
  const Key key{fragment.from, fragment.to, fragment.id, fragment.protocol};
  auto& partial = partials_[key];
  if (partial.pieces.empty()) partial.begun_ns = time_ns;
  if (partial.pieces.size() < kMaxPieces) {
    partial.pieces.try_emplace(fragment.fragment_offset, fragment.payload.begin(), fragment.payload.end());
  }
  if (!fragment.more_fragments) partial.size = static_cast<std::uint32_t>(end);
  auto payload = joined(partial);
  if (!payload) return {};
  partials_.erase(key);
  whole_ = std::move(*payload);
  auto packet = fragment;
  packet.payload = whole_;
  packet.more_fragments = false;
  packet.fragment_offset = 0;
  return packet;
}

std::optional<wire::Bytes> FragmentAssembler::joined(const Partial& partial) {
  if (!partial.size) return {};
  wire::Bytes bytes;
  for (const auto& [offset, piece] : partial.pieces) {
    if (offset > bytes.size()) return {};
    const auto known = std::min(bytes.size() - offset, piece.size());
    bytes.insert(bytes.end(), piece.begin() + static_cast<std::ptrdiff_t>(known), piece.end());
  }
  if (bytes.size() < *partial.size) return {};
  bytes.resize(*partial.size);
  return bytes;
}

void FragmentAssembler::forget_old(std::int64_t now_ns) {
  const auto lost =
      std::erase_if(partials_, [&](const auto& p) { return now_ns - p.second.begun_ns > kLongest; });
  losses_.add(kIncomplete, lost);
  if (partials_.size() < kMaxPackets) return;
  const auto older = [](const auto& a, const auto& b) { return a.second.begun_ns < b.second.begun_ns; };
  partials_.erase(std::min_element(partials_.begin(), partials_.end(), older));
  losses_.add(kIncomplete);
}

void FragmentAssembler::finish() {
  losses_.add(kIncomplete, partials_.size());
  partials_.clear();
}

}  // namespace crisp::capture
