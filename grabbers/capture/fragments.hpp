// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>

#include <crisp/capture_statistics.hpp>

#include "grabbers/devices/network.hpp"

namespace crisp::capture {

/// Reassembles IP packets from fragments in any order (RFC 791, RFC 8200). The first copy of bytes that came
/// twice is kept. Bounded: at most 64 packets at a time, none for longer than 30 s.
class FragmentAssembler {
 public:
  static constexpr std::string_view kIncomplete = "IP packets with missing fragments";

  /// @param fragment one whose is_fragment() is true
  /// @return the whole packet if this fragment completes it; its payload is valid until the next call
  std::optional<devices::IpPacket> take(const devices::IpPacket& fragment, std::int64_t time_ns);

  /// The stream of packets ends: what is incomplete is lost.
  void finish();

  const Counts& losses() const { return losses_; }

 private:
  struct Key {
    devices::IpAddress from, to;
    std::uint32_t id;
    std::uint8_t protocol;
    bool operator<(const Key& other) const {
      return std::tie(from, to, id, protocol) < std::tie(other.from, other.to, other.id, other.protocol);
    }
  };
  struct Partial {
    std::int64_t begun_ns = 0;
    std::map<std::uint32_t, wire::Bytes> pieces;  ///< by their offset
    std::optional<std::uint32_t> size;            ///< known from the last fragment
  };

  void forget_old(std::int64_t now_ns);
  static std::optional<wire::Bytes> joined(const Partial& partial);

  std::map<Key, Partial> partials_;
  wire::Bytes whole_;
  Counts losses_;
};

}  // namespace crisp::capture
