// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/ordered_capture.hpp"

#include <algorithm>
#include <utility>

namespace crisp::capture {
namespace {

bool is_regular(const std::filesystem::path& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none);
}

}  // namespace

OrderedCapture::OrderedCapture(const std::filesystem::path& path, std::function<bool()> interrupted)
    : path_(path),
      interrupted_(std::move(interrupted)),
      order_(is_regular(path) ? determine_packet_order(path, interrupted_) : PacketOrder{}) {
  open_what_is_due();
  if (is_regular(path)) size_ = std::filesystem::file_size(path);
}

/// Opens stretches until the next one begins after what is to be given next.
void OrderedCapture::open_what_is_due() {
  const auto is_later = [this](const OrderedSegment& stretch) {
    return std::ranges::any_of(
        parts_, [&](const Part& part) { return !part.is_over && part.packet.time_ns < stretch.first_ns; });
  };
  while (opened_ < order_.stretches.size() && !is_later(order_.stretches[opened_])) {
    const OrderedSegment& stretch = order_.stretches[opened_++];
    parts_.push_back({.file = std::make_unique<CaptureFile>(path_, stretch.begin, stretch.end, interrupted_),
                      .begin = stretch.begin.offset,
                      .shift_ns = stretch.shift_ns});
    if (!order_.shift_ns.empty()) parts_.back().file->keep_all_stamps();
    load(parts_.back());
  }
}

void OrderedCapture::load(Part& part) {
  const Packet* packet = part.file->next();
  part.is_over = packet == nullptr;
  if (part.is_over) return;
  part.packet = *packet;
  part.packet.time_ns += part.shift_ns;
}

void OrderedCapture::close_what_is_over() {
  std::erase_if(parts_, [this](const Part& part) {
    if (!part.is_over) return false;
    losses_.add(part.file->losses());
    notes_.add(part.file->notes());
    read_ += part.file->offset() - part.begin;
    return true;
  });
}

const Packet* OrderedCapture::next() {
  if (given_) load(parts_[*given_]);
  close_what_is_over();
  open_what_is_due();
  close_what_is_over();
  given_.reset();
  if (parts_.empty()) return nullptr;
  const auto first =
      std::ranges::min_element(parts_, {}, [](const Part& part) { return part.packet.time_ns; });
  given_ = static_cast<std::size_t>(first - parts_.begin());
  return &first->packet;
}

std::int64_t OrderedCapture::shift_of(const devices::IpPacket& packet) const {
  const auto found = order_.shift_ns.find(pair_of(packet));
  return found == order_.shift_ns.end() ? 0 : found->second;
}

Counts OrderedCapture::losses() const {
  Counts all = losses_;
  for (const Part& part : parts_) all.add(part.file->losses());
  return all;
}

Counts OrderedCapture::notes() const {
  Counts all = notes_;
  for (const Part& part : parts_) all.add(part.file->notes());
  return all;
}

std::uint64_t OrderedCapture::offset() const {
  std::uint64_t read = read_;
  for (const Part& part : parts_) read += part.file->offset() - part.begin;
  return read;
}

}  // namespace crisp::capture
