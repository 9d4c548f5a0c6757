// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/packet_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include "grabbers/capture/dissect.hpp"

namespace crisp::capture {
namespace {

constexpr std::size_t kMaxStretches = 1000;  // that are merged
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

double to_seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

/// Divides packets where their times go back.
class OrderWatch {
 public:
  /// @return whether a stretch begins with a packet of this time
  bool take(std::int64_t time_ns) {
    const bool begins = !newest_ns_ || time_ns < *newest_ns_ - kMaxReordering;
    newest_ns_ = begins ? time_ns : std::max(*newest_ns_, time_ns);
    return begins;
  }
  std::int64_t newest_ns() const { return *newest_ns_; }

 private:
  std::optional<std::int64_t> newest_ns_;
};

struct Stretches {
  std::vector<OrderedSegment> all;     ///< in the file's order, the first kMaxStretches
  std::vector<std::uint64_t> packets;  ///< of each
  std::size_t count = 0;
  std::uint64_t damaged = 0;  ///< stamps
};

Stretches find_stretches(const std::filesystem::path& path, const std::function<bool()>& interrupted) {
  Stretches found;
  OrderWatch watch;
  CaptureFile file(path, interrupted);
  while (const Packet* packet = file.next()) {
    const bool begins = watch.take(packet->time_ns);
    if (begins && ++found.count <= kMaxStretches) {
      const CaptureFile::Place place = file.place();
      if (!found.all.empty()) found.all.back().end = place.offset;
      found.all.push_back({.begin = place, .first_ns = packet->time_ns});
      found.packets.push_back(0);
    }
    if (found.count > kMaxStretches) continue;
    OrderedSegment& last = found.all.back();
    last.first_ns = std::min(last.first_ns, packet->time_ns);
    last.last_ns = watch.newest_ns();
    ++found.packets.back();
  }
  found.damaged = file.losses().of(file_loss::kDamagedStamps);
  return found;
}

/// Offset of one conversation's times against another's, by the order of their packets.
struct Offset {
  std::int64_t least = -kNever, most = kNever;  // [ns]

  bool is_constant() const { return least > -kNever && most < kNever && least <= most + kMaxReordering; }
  std::int64_t value() const { return least / 2 + most / 2; }
};

/// Evidence from the packets of a capture for why their times go back.
class ConversationScan {
 public:
  /// @param file is read from its begin to its end
  explicit ConversationScan(CaptureFile& file) {
    OrderWatch watch;
    while (const Packet* packet = file.next()) {
      if (watch.take(packet->time_ns)) ++stretch_;
      const auto ip = dissect_ip(*packet);
      if (const auto* found = std::get_if<devices::IpPacket>(&ip)) take(*found, packet->time_ns);
    }
  }

  /// Whether what was sent goes on over the end of a stretch: more connections do than do not.
  bool goes_on_after(std::size_t stretch) const {
    const auto found = connections_.find(stretch);
    return found != connections_.end() && found->second > 0;
  }

  /// [ns] What conversations' times are ahead of those of most others, if each one's own times ascend.
  std::map<IpPair, std::int64_t> offsets() const {
    std::map<IpPair, std::int64_t> best;
    std::size_t least_apart = conversations_.size();
    for (const auto& [reference, conversation] : conversations_) {
      if (conversation.went_back) return {};
      std::map<IpPair, std::int64_t> apart = offsets_from(reference);
      if (apart.size() >= least_apart) continue;
      least_apart = apart.size();
      best = std::move(apart);
    }
    return best;
  }

 private:
  struct Conversation {
    OrderWatch watch;
    std::uint64_t packets = 0;
    bool went_back = false;
  };
  struct Connection {
    std::uint32_t next = 0;  // sequence number
    std::size_t stretch = 0;
  };

  void take(const devices::IpPacket& ip, std::int64_t time_ns) {
    constexpr std::size_t kMax = 32;
    const IpPair pair = pair_of(ip);
    if (conversations_.size() < kMax || conversations_.contains(pair)) {
      Conversation& conversation = conversations_[pair];
      const bool first = conversation.packets++ == 0;
      if (conversation.watch.take(time_ns) && !first) conversation.went_back = true;
      compare(pair, time_ns);
    }
    bool damaged = false;
    const auto packet = dissect_transport(ip, damaged);
    if (packet && packet->key.transport == devices::Transport::Tcp && !packet->payload.empty())
      follow(*packet);
  }

  /// [ns] Of the conversations that are far from this one's time.
  std::map<IpPair, std::int64_t> offsets_from(const IpPair& reference) const {
    constexpr std::int64_t kFar = 2'000'000'000;  // programs write what they buffered for up to a second
    std::map<IpPair, std::int64_t> apart;
    for (const auto& [pair, conversation] : conversations_) {
      const auto offset = offsets_.find({pair, reference});
      if (offset == offsets_.end() || !offset->second.is_constant()) continue;
      if (std::abs(offset->second.value()) >= kFar) apart[pair] = offset->second.value();
    }
    return apart;
  }

  /// Earlier packets in the file arrived earlier.
  void compare(const IpPair& pair, std::int64_t time_ns) {
    for (const auto& [other, conversation] : conversations_) {
      if (other == pair) continue;
      const std::int64_t ahead = time_ns - conversation.watch.newest_ns();
      Offset& of_this = offsets_[{pair, other}];
      of_this.most = std::min(of_this.most, ahead);
      Offset& of_other = offsets_[{other, pair}];
      of_other.least = std::max(of_other.least, -ahead);
    }
  }

  void follow(const devices::TransportPacket& packet) {
    constexpr std::int32_t kNear = 1 << 20;  // [bytes] that may be missing
    const auto [found, is_new] = flows_.try_emplace(packet.key);
    Connection& connection = found->second;
    const auto ahead = static_cast<std::int32_t>(packet.sequence - connection.next);
    if (!is_new && connection.stretch + 1 == stretch_) {
      connections_[connection.stretch] += ahead >= 0 && ahead < kNear ? 1 : -1;
    }
    connection = {
        .next = packet.sequence + static_cast<std::uint32_t>(packet.payload.size()) + packet.missing,
        .stretch = stretch_};
  }

  std::size_t stretch_ = 0;  // the present one, from 1
  std::map<IpPair, Conversation> conversations_;
  std::map<std::pair<IpPair, IpPair>, Offset> offsets_;
  std::map<devices::FlowKey, Connection> flows_;
  std::map<std::size_t, int> connections_;  // that go on after a stretch, less those that do not
};

/// [ns] From one packet of a stretch to the next, on the average.
std::int64_t interval_of(const OrderedSegment& stretch, std::uint64_t packets) {
  constexpr std::int64_t kMax = 10'000'000;
  const auto intervals = static_cast<std::int64_t>(std::max<std::uint64_t>(1, packets - 1));
  return std::clamp<std::int64_t>((stretch.last_ns - stretch.first_ns) / intervals, 0, kMax);
}

/// Lets time go on where the hub's clock was set back.
void continue_time(Stretches& found, const ConversationScan& survey, PacketOrder& order) {
  std::int64_t largest = 0;
  std::size_t times = 0;
  for (std::size_t i = 1; i < found.all.size(); ++i) {
    if (!survey.goes_on_after(i)) continue;
    const OrderedSegment& before = found.all[i - 1];
    OrderedSegment& next = found.all[i];
    const std::int64_t back = before.last_ns - before.shift_ns - next.first_ns;
    next.shift_ns = before.last_ns + interval_of(before, found.packets[i - 1]) - next.first_ns;
    next.first_ns += next.shift_ns;
    next.last_ns += next.shift_ns;
    largest = std::max(largest, back);
    ++times;
  }
  if (times == 0) return;
  order.remarks.push_back(fmt::format(
      "the hub's clock was set back {} time(s) while it captured, by up to {:.3f} s: connections go on there. Times are continued. Set the hub's clock before capturing",
      times, to_seconds(largest)));
}

void sort_by_time(Stretches& found, PacketOrder& order) {
  constexpr std::int64_t kWorthAWord = 1'000'000'000;  // less is usual where several interfaces are captured
  const auto out_of_order = std::ranges::adjacent_find(
      found.all, [](const auto& a, const auto& b) { return b.first_ns < a.last_ns - kWorthAWord; });
  if (out_of_order != found.all.end()) {
    order.remarks.push_back(fmt::format(
        "its packets are not in the order of their times ({} parts, each in order): they are read in the order of their times",
        found.all.size()));
  }
  std::ranges::stable_sort(found.all, {}, &OrderedSegment::first_ns);
  order.stretches = std::move(found.all);
}

/// Whether the interfaces' clocks differ, each by a constant: then the file's order is right, and their times
/// are corrected.
bool join_clocks(const ConversationScan& survey, PacketOrder& order) {
  for (const auto& [pair, offset] : survey.offsets()) {
    order.shift_ns[pair] = -offset;
    order.remarks.push_back(fmt::format(
        "packets between {} and {} are stamped {:+.3f} s off their neighbours: the capture's interfaces have different clocks (TAI is 37 s ahead of UTC). The offset is removed, to within some milliseconds, which a calibration estimates as eta. Stamp all interfaces by one clock",
        devices::to_string(pair.first), devices::to_string(pair.second), to_seconds(offset)));
  }
  return !order.shift_ns.empty();
}

}  // namespace

PacketOrder determine_packet_order(const std::filesystem::path& path,
                                   const std::function<bool()>& interrupted) {
  constexpr std::size_t kInterleaved = 3;  // stretches: interfaces that take turns
  PacketOrder order;
  Stretches found = find_stretches(path, interrupted);
  if (found.count + found.damaged >= kInterleaved) {
    CaptureFile file(path, interrupted);
    file.keep_all_stamps();  // one of another clock between two would be taken for damaged
    if (join_clocks(ConversationScan(file), order)) return order;
  }
  if (found.count < 2) return order;
  if (found.count > kMaxStretches) {
    order.remarks.push_back(fmt::format(
        "the times of its packets go back {} times, too often to sort them: packets out of order are lost. Sort it with reordercap",
        found.count - 1));
    return order;
  }
  CaptureFile file(path, interrupted);
  continue_time(found, ConversationScan(file), order);
  sort_by_time(found, order);
  return order;
}

}  // namespace crisp::capture
