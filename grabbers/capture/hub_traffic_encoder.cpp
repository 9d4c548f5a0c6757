// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/hub_traffic_encoder.hpp"

#include <string>
#include <utility>

#include <crisp/error.hpp>

#include "grabbers/wire/cola_encoding.hpp"
#include "grabbers/wire/plate_sentence.hpp"
#include "grabbers/wire/scan_data.hpp"

namespace crisp::capture {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::uint16_t kLaserPort = 2112;
constexpr std::uint16_t kPlatePort = 4000;
constexpr std::size_t kFirstClientPort = 51000;
constexpr std::size_t kClientPorts = 14000;

Address hub_for(const Address& device, std::uint16_t port) {
  const bool ipv6 = device.ip.find(':') != std::string::npos;
  Address hub{.ip = ipv6 ? "fe80::100" : "192.168.0.100", .port = port};
  if (hub.ip == device.ip) {
    throw Error("the simulated hub has the address " + hub.ip + ", and so has a device of the rig",
                "give the device another address");
  }
  return hub;
}

/// The numbers follow a clock of 4 µs, as RFC 9293 (3.4.1) wants it: what a later session appends to a
/// capture is then not taken for the first one's bytes, sent again.
TcpSettings begun_at(std::int64_t time_ns) {
  const auto ticks = static_cast<std::uint32_t>(time_ns / 4000);
  return {.server_sequence = ticks, .client_sequence = ticks + (1U << 31)};
}

Address with_port(Address address, std::uint16_t usual) {
  if (address.port == 0) address.port = usual;
  return address;
}

}  // namespace

HubTrafficEncoder::HubTrafficEncoder(const Rig& rig, ColaLanguage language, FrameSink sink)
    : language_(language), sink_(std::move(sink)), lasers_(rig.lasers.size()) {
  const Address& plate = rig.plate.address;
  if (!rig.plate.encoder_of) plate_.emplace(with_port(plate, kPlatePort), hub_for(plate, kPlatePort), sink_);
  for (const RigLaser& laser : rig.lasers) addresses_.push_back(with_port(laser.address, kLaserPort));
}

void HubTrafficEncoder::connect(std::size_t laser, std::int64_t time_ns) {
  const auto port = static_cast<std::uint16_t>(kFirstClientPort + connections_++ % kClientPorts);
  const Address& server = addresses_.at(laser);
  auto& connection = lasers_.at(laser);
  connection = std::make_unique<TcpConversation>(server, hub_for(server, port), sink_, begun_at(time_ns));
  connection->open(time_ns);
  const std::vector<wire::ColaValue> on{std::uint8_t{1}};
  connection->send(TcpSide::Client, wire::cola_message("sEN", wire::kScanDataName, on, language_),
                   time_ns + kMillisecond);
  connection->send(TcpSide::Server, wire::cola_message("sEA", wire::kScanDataName, on, language_),
                   time_ns + 2 * kMillisecond);
}

void HubTrafficEncoder::telegram(std::size_t laser, wire::ByteView bytes, std::int64_t time_ns) {
  lasers_.at(laser)->send(TcpSide::Server, bytes, time_ns);
}

void HubTrafficEncoder::reading(const PlateReading& reading) {
  if (plate_) plate_->send(wire::as_bytes(wire::encode_plate_sentence(reading)), reading.receipt_ns);
}

void HubTrafficEncoder::close(std::int64_t time_ns) {
  for (const auto& laser : lasers_) {
    if (laser) laser->close(time_ns);
  }
}

}  // namespace crisp::capture
