// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <crisp/capture_statistics.hpp>

#include "grabbers/capture/byte_order.hpp"
#include "grabbers/capture/file_window.hpp"
#include "grabbers/capture/packet.hpp"

namespace crisp::capture {

inline constexpr std::size_t kPcapFileHeader = 24;  ///< bytes, before the first record

/// The records of a pcap file: both byte orders, micro- and nanoseconds. Not libpcap, because that ends at
/// the first damaged record; this reader searches for the next valid one and counts the bytes between.
class PcapRecords {
 public:
  /// Whether the file begins like a pcap file.
  static bool recognises(wire::ByteView begin);

  /// @throws Error if the file's header is cut off
  PcapRecords(FileWindow& file, Counts& losses);

  bool next(Packet& packet);  ///< false at the end of the file

 private:
  struct Header {
    std::int64_t time_ns = 0;
    std::uint32_t captured = 0, original = 0;
  };

  std::optional<Header> header(wire::ByteView bytes) const;
  std::optional<Header> believable_header(wire::ByteView bytes, std::size_t at,
                                          std::optional<std::int64_t> near_ns) const;
  std::optional<std::size_t> find_record(wire::ByteView bytes, std::size_t from) const;
  bool resynchronise(std::size_t from);
  bool cut_off(std::size_t rest);

  FileWindow& file_;
  Counts& losses_;
  ByteOrder order_ = ByteOrder::Little;
  std::uint32_t link_type_ = 0;
  std::int64_t ns_per_tick_ = 1000;
  std::size_t header_size_ = 16;
  std::optional<std::int64_t> last_time_ns_;
};

}  // namespace crisp::capture
