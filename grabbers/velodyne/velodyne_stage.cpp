// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/velodyne/velodyne_stage.hpp"

#include <fmt/format.h>

#include <crisp/error.hpp>

#include "grabbers/capture/capture_file.hpp"
#include "grabbers/capture/dissect.hpp"

namespace crisp::velodyne {
namespace {

constexpr double kMaxGap = 0.05;  // [s] of the azimuths, which come every 0.11 ms

std::optional<devices::TransportPacket> datagram_of(const capture::Packet& packet) {
  const auto found = capture::dissect_ip(packet);
  const auto* ip = std::get_if<devices::IpPacket>(&found);
  if (ip == nullptr || ip->is_fragment()) return {};
  bool damaged = false;
  auto datagram = capture::dissect_transport(*ip, damaged);
  if (damaged || !datagram || datagram->key.transport != devices::Transport::Udp) return {};
  return datagram;
}

}  // namespace

void VelodyneStage::describe(StageDescription<VelodyneStage>& d) {
  d.name("grabber.velodyne").summary("reads the lasers of a Velodyne VLP-16 from a capture");
  d.details(
      "A VLP-16 is sixteen lasers with a fixed beam each on one turning head: the rig describes each by its mount, minus (90deg + its elevation), with alpha = -90deg (configs/real/vlp16_rig.yaml). The head's azimuth, which grows clockwise, is the plate's angle with the other sign; between packets' blocks it is interpolated. Times are the device's, counted from the first packet's receipt. Packets of other kinds are counted.");
  d.gives<PlateTrajectory>().gives<Measurements>();
  d.option("file", &VelodyneStage::file_, "capture (pcap or pcapng)").required();
}

void VelodyneStage::check(const RunSettings& run) const {
  if (run.rig.lasers.size() == kVelodyneLasers) return;
  throw Error(fmt::format("the rig has {} lasers, and a VLP-16 has 16", run.rig.lasers.size()),
              "give configs/real/vlp16_rig.yaml: --rig");
}

void VelodyneStage::take(const VelodynePacket& packet, std::int64_t receipt_ns, const Rig& rig) {
  if (!head_) {
    head_.emplace(receipt_ns, kMaxGap);
    last_us_ = packet.time_us;
  }
  packet_time_ += 1e-6 * static_cast<double>(velodyne_passed_us(last_us_, packet.time_us));
  last_us_ = packet.time_us;
  Measurements beams;
  beams.epoch_ns = head_->epoch_ns();
  for (std::size_t b = 0; b < kVelodyneBlocks; ++b) {
    head_->add_azimuth(packet_time_ + velodyne_shot(b, 0, 0), -packet.azimuth[b]);
    for (std::size_t firing = 0; firing < 2; ++firing) {
      for (std::size_t laser = 0; laser < kVelodyneLasers; ++laser) {
        const auto& one = packet.returns[b][firing][laser];
        if (!(one.range > 0)) continue;
        beams.range.push_back(one.range);
        beams.mirror_angle.push_back(static_cast<float>(-rig.lasers[laser].mount));
        beams.time.push_back(packet_time_ + velodyne_shot(b, firing, laser));
        beams.laser.push_back(static_cast<std::uint16_t>(laser));
        beams.remission.push_back(static_cast<float>(one.intensity));
        beams.beam.push_back(0);
      }
    }
  }
  head_->add(std::move(beams));
}

void VelodyneStage::process(const Inputs&, Outputs& out, Context& context) {
  context.reads(file_);
  capture::CaptureFile capture(file_, [&context] { return context.interrupted(); });
  std::uint64_t packets = 0;
  while (const capture::Packet* packet = capture.next()) {
    if (context.interrupted()) return;
    const auto datagram = datagram_of(*packet);
    const auto data = datagram ? parse_velodyne(datagram->payload) : std::nullopt;
    if (!data) {
      context.count("packets that are not a VLP-16's measurements");
      continue;
    }
    if (head_ && velodyne_passed_us(last_us_, data->time_us) > kVelodyneHour_us / 2) {
      context.count("packets that are older than the one before");
      continue;
    }
    take(*data, packet->time_ns, context.rig());
    ++packets;
    if (auto piece = head_->take_piece()) std::move(*piece).give_to(out);
  }
  for (const auto& [what, n] : capture.losses().all()) context.count(what, n);
  if (!head_ || head_->azimuths() < 2) {
    throw Error(file_.string() + " holds no measurements of a VLP-16", "check the captured interface");
  }
  context.report({{"packets", packets}, {"turns", head_->turns()}});
  context.print(
      fmt::format("{} packets, {:.2f} turns in {:.3f} s", packets, head_->turns(), head_->duration()));
  head_->take_rest().give_to(out);
}

}  // namespace crisp::velodyne
