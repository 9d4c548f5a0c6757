// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include "grabbers/wire/bytes.hpp"

namespace crisp::capture {

/// One packet of a capture.
struct Packet {
  std::int64_t time_ns = 0;         ///< [ns since the Unix epoch] capture time
  std::uint32_t link_type = 0;      ///< LINKTYPE_… of the interface
  std::uint32_t original_size = 0;  ///< [bytes] on the wire; more than there are if the capture cut it short
  wire::ByteView bytes;             ///< valid until the next packet is read
};

/// Names of what a capture file loses by itself.
namespace file_loss {
inline constexpr std::string_view kDamagedRecords = "damaged records in the file";
inline constexpr std::string_view kSkippedBytes = "bytes skipped in the file to find the next record";
inline constexpr std::string_view kCutOff = "bytes of a record truncated by the end of the file";
inline constexpr std::string_view kDamagedStamps = "packets with a damaged time stamp";
inline constexpr std::string_view kBeforeItsTime = "packets earlier than their predecessor";
inline constexpr std::string_view kNoStamp = "packets without a time stamp";
inline constexpr std::string_view kUnknownInterface =
    "packets of an interface that the file does not describe";
inline constexpr std::string_view kUnknownBlocks = "blocks of unknown kinds in the file";
inline constexpr std::string_view kNotCaptured =
    "packets dropped by the capturing computer, by its own count";
}  // namespace file_loss

/// Longest plausible packet [bytes]; the largest snapshot length of tcpdump.
inline constexpr std::uint32_t kLargestPacket = 262144;

}  // namespace crisp::capture
