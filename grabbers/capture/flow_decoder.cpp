// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/flow_decoder.hpp"

#include <algorithm>
#include <utility>

#include "grabbers/devices/framing_losses.hpp"

namespace crisp::capture {
namespace {

constexpr std::size_t kPatience = 256 * 1024;  // [bytes] within which a flow must contain a known telegram

bool is_request(const wire::ColaTelegram& telegram) {
  return telegram.command == "sRN" || telegram.command == "sWN" || telegram.command == "sMN" ||
         telegram.command == "sEN";
}

}  // namespace

FlowDecoder::FlowDecoder(const devices::FlowKey& key, devices::DeviceRegistry& devices,
                         devices::DeviceRegistry::Device* known, const CaptureSettings& settings,
                         const Give& give)
    : key_(key),
      devices_(devices),
      device_(known),
      settings_(settings),
      give_(give),
      tcp_(*this, static_cast<std::int64_t>(1e9 * settings.max_wait)) {
  const bool laser = known == nullptr || known->kind == DeviceKind::Laser;
  const bool plate = known == nullptr || known->kind == DeviceKind::Plate;
  if (laser && key.transport == devices::Transport::Tcp) cola_ = std::make_unique<wire::ColaFramer>();
  if (plate) plate_ = plate_framer();
  const bool sure = known != nullptr && (known->port != 0 || devices::is_sick_port(key.from.port));
  if (sure) speech_ = laser ? Speech::Cola : Speech::Plate;
}

std::unique_ptr<wire::PlateFramer> FlowDecoder::plate_framer() const {
  const auto bytes =
      key_.transport == devices::Transport::Tcp ? wire::PlateBytes::stream : wire::PlateBytes::datagrams;
  return std::make_unique<wire::PlateFramer>(device_ == nullptr ? std::nullopt : device_->line, bytes);
}

/// Whether to take the packet now. Where checksums are usually right, one with a wrong checksum is damaged,
/// and the hub did not take it either; where they are usually wrong, some network card is to blame. The first
/// wrong ones wait until it is clear which.
bool FlowDecoder::trust(const devices::TransportPacket& packet, std::int64_t time_ns) {
  if (packet.checksum == devices::ChecksumVerdict::Right) {
    ++right_checksums_;
    dropped_ += doubtful_.size();
    doubtful_.clear();
  }
  if (packet.checksum != devices::ChecksumVerdict::Wrong) return true;
  ++wrong_checksums_;
  constexpr std::uint64_t kMaxDoubtful = 3, kFew = 40, kUsually = 20;
  if (right_checksums_ == 0 && wrong_checksums_ <= kMaxDoubtful) {
    doubtful_.push_back({packet, wire::Bytes(packet.payload.begin(), packet.payload.end()), time_ns});
    return false;
  }
  take_doubtful();
  const bool few = right_checksums_ + wrong_checksums_ < kFew;
  const bool damaged = right_checksums_ > (few ? 1 : kUsually) * wrong_checksums_;
  if (damaged) ++dropped_;
  return !damaged;
}

/// Checksums are wrong here as a habit: what waited is good.
void FlowDecoder::take_doubtful() {
  for (auto& [packet, payload, time_ns] : std::exchange(doubtful_, {})) {
    packet.payload = payload;
    take_trusted(packet, time_ns);
  }
}

void FlowDecoder::take(const devices::TransportPacket& packet, std::int64_t time_ns) {
  last_ns_ = time_ns;
  if (trust(packet, time_ns)) take_trusted(packet, time_ns);
}

void FlowDecoder::take_trusted(const devices::TransportPacket& packet, std::int64_t time_ns) {
  if (packet.missing > 0) ++cut_short_;
  if (key_.transport == devices::Transport::Tcp) {
    if (packet.syn && speech_ == Speech::Nothing) {  // a new connection may carry something else
      speech_ = Speech::Unknown;
      unconvincing_bytes_ = 0;
      cola_ = std::make_unique<wire::ColaFramer>();
      plate_ = plate_framer();
    }
    if (speech_ != Speech::Nothing) tcp_.take(packet, time_ns);
  } else if (plate_) {
    data(packet.payload, time_ns);
    gap();
  }
}

void FlowDecoder::data(wire::ByteView bytes, std::int64_t arrival_ns) {
  if (cola_) cola_->feed(bytes, arrival_ns, [&](const wire::ColaFrame& frame) { take_frame(frame); });
  if (plate_) plate_->feed(bytes, arrival_ns, [&](const PlateReading& reading) { take_reading(reading); });
  if (speech_ != Speech::Unknown) {
    if (speech_ != Speech::Cola) cola_.reset();
    if (speech_ != Speech::Plate) plate_.reset();
    return;
  }
  unconvincing_bytes_ += bytes.size();
  if (unconvincing_bytes_ > kPatience) {
    speech_ = Speech::Nothing;
    cola_.reset();
    plate_.reset();
  }
}

void FlowDecoder::gap() {
  if (cola_) cola_->gap([&](const wire::ColaFrame& frame) { take_frame(frame); });
  if (plate_) plate_->gap([&](const PlateReading& reading) { take_reading(reading); });
}

void FlowDecoder::repeated(wire::ByteView bytes) {
  if (device_ == nullptr || speech_ != Speech::Cola) return;
  wire::ColaFramer().feed(bytes, 0, [&](const wire::ColaFrame& frame) { device_->log.note_repeated(frame); });
}

/// Whether the flow speaks this language of a device that is known from now on.
bool FlowDecoder::settle(Speech speech) {
  if (speech_ == Speech::Unknown) {
    const auto kind = speech == Speech::Cola ? DeviceKind::Laser : DeviceKind::Plate;
    if (device_ == nullptr) device_ = devices_.other(key_, kind);
    speech_ = device_ != nullptr ? speech : Speech::Nothing;
  }
  return speech_ == speech;
}

void FlowDecoder::take_frame(const wire::ColaFrame& frame) {
  if (speech_ == Speech::Unknown && device_ == nullptr) {
    const auto telegram = wire::parse_cola(frame.payload, frame.language);
    if (!telegram) return;
    if (is_request(*telegram)) speech_ = Speech::Nothing;  // the hub's side of a conversation
  }
  if (!settle(Speech::Cola)) return;
  auto scan = device_->log.take(frame, settings_.encoder_widths);
  if (!scan || !is_of_rig()) return;
  if (devices::WiredEncoder* encoder = devices_.wired_encoder()) {
    if (const auto reading = encoder->read(*scan, settings_.encoder_widths)) give_(*reading);
  }
  give_(std::move(scan));
}

void FlowDecoder::take_reading(const PlateReading& reading) {
  if (!settle(Speech::Plate)) return;
  const auto fresh = device_->log.take(reading);
  if (fresh && is_of_rig()) give_(*fresh);
}

void FlowDecoder::expire(std::int64_t now_ns) { tcp_.expire(now_ns); }

std::optional<std::int64_t> FlowDecoder::waiting_since(std::int64_t earliest_ns) const {
  std::optional<std::int64_t> since;
  for (const auto waiting : {tcp_.waiting_since(), cola_ ? cola_->waiting_since() : std::nullopt}) {
    if (waiting && *waiting >= earliest_ns) since = std::min(since.value_or(*waiting), *waiting);
  }
  return since;
}

void FlowDecoder::finish() {
  take_doubtful();
  tcp_.finish();
  gap();
  if (device_ != nullptr && (speech_ == Speech::Cola || speech_ == Speech::Plate)) report();
}

void FlowDecoder::report() {
  auto& log = device_->log;
  const auto& tcp = tcp_.counts();
  log.lose("packets with a wrong checksum", dropped_);
  log.lose("packets truncated by the capture", cut_short_);
  log.lose("bytes of TCP missing from the capture", tcp.lost_bytes);
  log.note("TCP connections", tcp.connections);
  log.note("retransmitted TCP segments", tcp.repeated_segments);
  log.note("TCP segments out of order", tcp.late_segments);
  log.note("TCP segments out of the window", tcp.out_of_window);
  if (cola_) devices::note_framing(cola_->counts(), log);
  if (plate_) devices::note_framing(plate_->counts(), log);
}

}  // namespace crisp::capture
