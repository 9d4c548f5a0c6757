// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/pcap_extent.hpp"

#include <fmt/format.h>

#include <bit>

#include <crisp/error.hpp>

#include "grabbers/capture/pcap_records.hpp"

namespace crisp::capture {
namespace {

bool is_nanosecond_ethernet(wire::ByteView header) {
  constexpr std::uint32_t kNanosecondMagic = 0xa1b23c4d, kEthernet = 1;
  constexpr auto kOrder = std::endian::native == std::endian::little ? ByteOrder::Little : ByteOrder::Big;
  return header.size() == kPcapFileHeader &&
         number_at<std::uint32_t>(header, 0, kOrder) == kNanosecondMagic &&
         number_at<std::uint32_t>(header, 20, kOrder) == kEthernet;
}

}  // namespace

PcapExtent pcap_extent(const std::filesystem::path& path) {
  FileWindow file(path);
  if (!is_nanosecond_ethernet(file.peek(kPcapFileHeader))) {
    throw Error(
        fmt::format("{} exists and cannot be continued: it is no nanosecond Ethernet pcap", path.string()),
        "give another name, or remove the file");
  }
  Counts losses;
  PcapRecords records(file, losses);
  PcapExtent extent{.bytes = file.size(), .whole = kPcapFileHeader};
  Packet packet;
  while (records.next(packet)) {
    extent.whole = file.offset();
    extent.damaged_records = losses.of(file_loss::kDamagedRecords);
    extent.damaged_bytes = losses.of(file_loss::kSkippedBytes);
  }
  extent.ends_in_record = losses.of(file_loss::kCutOff) == extent.bytes - extent.whole;
  return extent;
}

}  // namespace crisp::capture
