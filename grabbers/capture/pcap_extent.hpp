// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

namespace crisp::capture {

/// Extent of the records of a pcap file, read past damaged ones.
struct PcapExtent {
  std::uint64_t bytes = 0;            ///< of the file
  std::uint64_t whole = 0;            ///< [bytes] where its last whole record ends
  std::uint64_t damaged_records = 0;  ///< before that
  std::uint64_t damaged_bytes = 0;    ///< of those records
  bool ends_in_record = false;        ///< behind that is the begin of one more record, and nothing else

  /// Whether a reader finds what is appended: behind the last whole record, less a half-written one.
  bool can_be_continued() const { return whole == bytes || ends_in_record; }
};

/// @throws Error if the file cannot be read, or is no nanosecond Ethernet pcap of this machine's byte order
PcapExtent pcap_extent(const std::filesystem::path& path);

}  // namespace crisp::capture
