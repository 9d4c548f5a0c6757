// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <crisp/capture_statistics.hpp>

#include "grabbers/capture/byte_order.hpp"
#include "grabbers/capture/file_window.hpp"
#include "grabbers/capture/packet.hpp"

namespace crisp::capture {

/// The blocks of a pcapng file (draft-ietf-opsawg-pcapng): any number of sections and interfaces, each with
/// its byte order, link type, time resolution and offset. Not libpcap, because that refuses interfaces of
/// different link types and sections of different byte orders, and ends at the first damaged block; this
/// reader searches for the next valid one and counts the bytes between.
class PcapngBlocks {
 public:
  /// Whether the file begins like a pcapng file.
  static bool recognises(wire::ByteView begin);

  PcapngBlocks(FileWindow& file, Counts& losses) : file_(file), losses_(losses) {}

  bool next(Packet& packet);  ///< false at the end of the file

  struct Interface {
    std::uint32_t link_type = 0;
    std::uint8_t resolution = 6;  ///< if_tsresol: 10^-n s, or with the highest bit 2^-n s
    std::int64_t offset_s = 0;    ///< if_tsoffset
    std::uint64_t dropped = 0;    ///< isb_ifdrop, as last reported
  };
  /// The context that earlier blocks set for later ones.
  struct Section {
    ByteOrder order = ByteOrder::Little;
    std::vector<Interface> interfaces = {};
  };
  Section section() const { return {order_, interfaces_}; }
  void go_on(const Section& section) {
    order_ = section.order;
    interfaces_ = section.interfaces;
  }

 private:
  std::uint32_t u32(wire::ByteView bytes, std::size_t at) const {
    return number_at<std::uint32_t>(bytes, at, order_);
  }
  std::optional<std::size_t> block_size(wire::ByteView begin) const;
  bool is_block(wire::ByteView bytes, std::size_t at) const;
  bool holds_a_block(wire::ByteView bytes) const;
  std::optional<wire::ByteView> next_block();  // whole; nothing at the end of the file
  bool enter_section(wire::ByteView begin);
  bool resynchronise();
  bool read_packet(std::uint32_t type, wire::ByteView body, Packet& packet);
  void describe_interface(wire::ByteView body);
  void read_statistics(wire::ByteView body);
  template <class Take>
  void options(wire::ByteView bytes, Take take) const;
  static std::optional<std::int64_t> to_ns(std::uint64_t ticks, const Interface& interface);

  FileWindow& file_;
  Counts& losses_;
  ByteOrder order_ = ByteOrder::Little;
  std::vector<Interface> interfaces_;
};

}  // namespace crisp::capture
