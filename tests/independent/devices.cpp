// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/devices.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/independent/telegrams.hpp"

namespace independent {
namespace {

constexpr double kWrap = 4294967296.0;
constexpr std::size_t kSegment = 1460;   // [bytes] payload of a full TCP segment
constexpr double kSegmentTime = 120e-6;  // [s] between full segments at 100 Mbit/s
constexpr double kRetransmission = 0.2;  // [s] until a lost segment is sent again
constexpr double kReadingJitter = 0.03;  // sd of a reading's instant, as a share of the readings' interval

std::uint32_t modulo_2_32(double value) {
  return static_cast<std::uint32_t>(value - kWrap * std::floor(value / kWrap));
}

/// One TCP connection as the hub sees it.
class Connection {
 public:
  Connection(Endpoint device, Endpoint hub, double loss, std::mt19937_64& random,
             std::vector<Packet>& packets)
      : device_(std::move(device)),
        hub_(std::move(hub)),
        loss_(loss),
        random_(random),
        packets_(packets),
        device_sequence_(static_cast<std::uint32_t>(random())),
        hub_sequence_(static_cast<std::uint32_t>(random())) {}

  void open(double time) {
    packets_.push_back({time, tcp_packet(hub_, device_, hub_sequence_++, 0, kSyn, "")});
    packets_.push_back(
        {time + 4e-4, tcp_packet(device_, hub_, device_sequence_++, hub_sequence_, kSyn | kAcknowledge, "")});
    acknowledge(time + 4.5e-4);
  }
  void request(double time, const std::string& command) {
    packets_.push_back(
        {time, tcp_packet(hub_, device_, hub_sequence_, device_sequence_, kPush | kAcknowledge, command)});
    hub_sequence_ += static_cast<std::uint32_t>(command.size());
  }
  /// The device's bytes, complete at the hub at `time`; they need at most `way` seconds.
  void deliver(double time, double way, const std::string& bytes) {
    const std::size_t segments = (bytes.size() + kSegment - 1) / kSegment;
    const double apart = std::min(kSegmentTime, 0.9 * way / static_cast<double>(segments));
    for (std::size_t i = 0; i < segments; ++i) {
      const std::string part = bytes.substr(i * kSegment, kSegment);
      const int flags = kAcknowledge | (i + 1 == segments ? kPush : 0);
      const Packet packet{time - apart * static_cast<double>(segments - 1 - i),
                          tcp_packet(device_, hub_, device_sequence_, hub_sequence_, flags, part)};
      const bool is_repeated = even_(random_) < loss_, is_lost = is_repeated && even_(random_) < 0.5;
      if (!is_lost) packets_.push_back(packet);
      if (is_repeated) packets_.push_back({packet.time + kRetransmission, packet.data});
      device_sequence_ += static_cast<std::uint32_t>(part.size());
    }
    acknowledge(time + 4e-5);
  }

 private:
  void acknowledge(double time) {
    packets_.push_back({time, tcp_packet(hub_, device_, hub_sequence_, device_sequence_, kAcknowledge, "")});
  }

  Endpoint device_, hub_;
  double loss_;
  std::mt19937_64& random_;
  std::vector<Packet>& packets_;
  std::uint32_t device_sequence_, hub_sequence_;
  std::uniform_real_distribution<> even_;
};

}  // namespace

std::uint32_t read_clock(const ClockSetup& clock, double time) {
  return modulo_2_32(std::floor(clock.start + 1e6 * (1 + clock.skew) * time));
}

Link::Link(const LinkSetup& setup, std::mt19937_64& random)
    : minimum_(setup.minimum), extra_(setup.shape, setup.mean_extra / setup.shape), random_(random) {}

double Link::arrival(double sent) {
  last_ = std::max(last_ + 1e-6, sent + minimum_ + extra_(random_));
  smallest_ = std::min(smallest_, last_ - sent);
  return last_;
}

Traffic send_scans(const Setup& setup, std::size_t index, const std::vector<Scan>& scans,
                   const Effect& effect, std::mt19937_64 random) {
  const LaserSetup& laser = setup.lasers[index];
  const auto clock_at = [&](double time) {
    const bool acts = effect.clock && effect.acts_on(index);
    return read_clock(laser.clock, time + (acts ? effect.size * effect.clock(time) : 0));
  };
  Traffic traffic;
  const int hub_port = std::uniform_int_distribution<>(32768, 60999)(random);
  Connection connection({laser.address, laser.port}, {setup.wire.hub, hub_port}, setup.wire.loss, random,
                        traffic.packets);
  if (setup.wire.has_handshake) {
    connection.open(-0.1);
    connection.request(-0.098, short_telegram("sEN LMDscandata", 1, setup.wire.is_text));
    connection.deliver(-0.09, 1e-3, short_telegram("sEA LMDscandata", 1, setup.wire.is_text));
  }
  Link link(laser.link, random);
  ScanHeader header;
  header.serial = std::uniform_int_distribution<std::uint32_t>(9000000, 23999999)(random);
  header.telegram_counter = static_cast<std::uint16_t>(random());
  header.scan_counter = static_cast<std::uint16_t>(random());
  const double powered_up = -std::uniform_real_distribution<>(20, 20000)(random);
  for (const auto& scan : scans) {
    header.stamp_us = clock_at(scan.stamp);
    header.transmission_us = clock_at(scan.transmission);
    header.seconds_since_start = scan.transmission - powered_up;
    const double arrival = link.arrival(scan.transmission);
    connection.deliver(arrival, arrival - scan.transmission,
                       scan_telegram(laser.kind, laser.name, setup.wire, header, scan));
    ++header.telegram_counter;
    ++header.scan_counter;
  }
  traffic.smallest_delay = link.smallest();
  return traffic;
}

Traffic send_readings(const Setup& setup, const PlateMotion& motion, const Effect& effect,
                      std::mt19937_64 random) {
  const auto& plate = setup.plate;
  Traffic traffic;
  Link link(plate.link, random);
  std::normal_distribution<> normal;
  std::uniform_real_distribution<> even;
  const Endpoint from{plate.address, plate.port}, to{setup.wire.hub, plate.port};
  const double interval = 1 / plate.rate,
               steps = (plate.is_clockwise ? -1 : 1) * plate.counts / (2 * std::numbers::pi);
  auto sequence = static_cast<std::uint16_t>(random());
  std::string datagram;
  int joined = 0;
  for (int i = 0; i * interval < setup.duration; ++i) {
    const double time = interval * (i + std::clamp(kReadingJitter * normal(random), -0.2, 0.2));
    double angle = motion.angle(time) + (effect.encoder ? effect.size * effect.encoder(time) : 0);
    for (const auto& [begin, jump] : plate.slips) angle += time >= begin ? jump : 0;
    const double count = plate.start_count + std::floor(steps * angle);
    datagram += plate_sentence(sequence++, read_clock(plate.clock, time), modulo_2_32(count));
    if (++joined < plate.readings_per_datagram) continue;
    const double arrival = link.arrival(time);
    if (even(random) >= plate.loss) traffic.packets.push_back({arrival, udp_packet(from, to, datagram)});
    datagram.clear();
    joined = 0;
  }
  traffic.smallest_delay = link.smallest();
  return traffic;
}

}  // namespace independent
