// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/capture_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <crisp/error.hpp>

namespace crisp::capture {

namespace {

/// Files of other kinds that are taken for captures, by their first bytes, and what to do with them.
Error no_capture(const std::filesystem::path& path, std::string_view begin) {
  if (begin.starts_with("# .PCD") || begin.starts_with("VERSION "))
    return Error(path.string() + " is a PCD file, not a capture",
                 "grabber.pcd reads measurements, grabber.cloud a cloud");
  return Error(path.string() + " is neither pcap nor pcapng",
               "captures come from tcpdump, dumpcap or Wireshark");
}

}  // namespace

CaptureFile::CaptureFile(const std::filesystem::path& path, const Place& from, std::uint64_t end,
                         std::function<bool()> interrupted)
    : file_(path, std::move(interrupted)), end_(end) {
  constexpr std::size_t kDistinctive = 8;  // bytes
  const auto begin = file_.peek(kDistinctive);
  if (begin.empty()) throw Error(path.string() + " is empty", "capture it again");
  if (PcapRecords::recognises(begin)) {
    records_.emplace<PcapRecords>(file_, losses_);
  } else if (PcapngBlocks::recognises(begin)) {
    records_.emplace<PcapngBlocks>(file_, losses_);
  } else {
    throw no_capture(path, wire::as_text(begin));
  }
  if (from.offset == 0) return;
  file_.move_to(from.offset);
  auto* pcapng = std::get_if<PcapngBlocks>(&records_);
  if (pcapng != nullptr && from.section) pcapng->go_on(*from.section);
}

CaptureFile::Place CaptureFile::place() const {
  const auto* pcapng = std::get_if<PcapngBlocks>(&records_);
  return {.offset = current_.offset,
          .section = pcapng == nullptr ? std::nullopt : std::optional(pcapng->section())};
}

void CaptureFile::load(Slot& slot) {
  slot.full = false;
  slot.offset = file_.offset();
  if (slot.offset >= end_) return;
  if (auto* pcap = std::get_if<PcapRecords>(&records_)) slot.full = pcap->next(slot.packet);
  if (auto* pcapng = std::get_if<PcapngBlocks>(&records_)) slot.full = pcapng->next(slot.packet);
  if (!slot.full) return;
  slot.bytes.assign(slot.packet.bytes.begin(), slot.packet.bytes.end());
  slot.packet.bytes = slot.bytes;
}

bool CaptureFile::stamp_is_damaged() const {
  constexpr std::int64_t kTolerance = 1'000'000'000, kHour = 3600 * kTolerance;
  const auto time = current_.packet.time_ns;
  if (!ahead_.full) return before_ns_ && std::abs(time - *before_ns_) > kHour;
  const auto after = ahead_.packet.time_ns;
  if (!before_ns_) return time > after + kTolerance;
  return *before_ns_ <= after && (time < *before_ns_ - kTolerance || time > after + kTolerance);
}

std::int64_t CaptureFile::earliest_receipt() const {
  const auto time = current_.packet.time_ns;
  const bool neighbours_in_order = before_ns_ && ahead_.full && *before_ns_ <= ahead_.packet.time_ns;
  return neighbours_in_order ? std::max(time, *before_ns_) : time;
}

const Packet* CaptureFile::next() {
  if (!std::exchange(begun_, true)) load(ahead_);
  while (true) {
    std::swap(current_, ahead_);
    if (!current_.full) return nullptr;
    load(ahead_);
    if (keeps_all_ || !stamp_is_damaged()) break;
    losses_.add(file_loss::kDamagedStamps);
  }
  const auto time = current_.packet.time_ns;
  if (!keeps_all_) current_.packet.time_ns = earliest_receipt();
  if (current_.packet.time_ns != time) notes_.add(file_loss::kBeforeItsTime);
  before_ns_ = time;
  return &current_.packet;
}

}  // namespace crisp::capture
