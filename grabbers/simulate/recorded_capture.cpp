// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/recorded_capture.hpp"

#include <string_view>

#include "grabbers/wire/cola.hpp"
#include "grabbers/wire/plate_sentence.hpp"
#include "grabbers/wire/scan_data.hpp"
#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kHold = 100 * kMillisecond;  // longer than any frame lies before or behind its event
constexpr std::uint16_t kLaserPort = 2112;
constexpr std::uint16_t kPlatePort = 4000;
constexpr std::uint16_t kFirstClientPort = 51000;
constexpr std::size_t kHeaders = 54;  // Ethernet, IPv4 and TCP: damage behind them hits the payload

Address hub_for(const Address& device, std::uint16_t port) {
  const bool ipv6 = device.ip.find(':') != std::string::npos;
  Address hub{.ip = ipv6 ? "fe80::100" : "192.168.0.100", .port = port};
  if (hub.ip == device.ip) {
    throw Error("the simulated hub has the address " + hub.ip + ", and so has a device of the rig",
                "give the device another address");
  }
  return hub;
}

Address with_port(Address address, std::uint16_t usual) {
  if (address.port == 0) address.port = usual;
  return address;
}

Bytes subscription(std::string_view command, ColaLanguage language) {
  const std::string on = language == ColaLanguage::A ? "1" : std::string(1, '\1');
  return cola_frame(as_bytes(std::string(command) + " " + std::string(kScanDataName) + " " + on), language);
}

}  // namespace

FaultyWire::FaultyWire(const WireFaults& faults, std::uint64_t seed, FrameSink sink)
    : faults_(faults), random_(seed, "wire"), sink_(std::move(sink)) {
  for (const double share : {faults.lost, faults.repeated, faults.damaged}) {
    if (!(share >= 0 && share <= 1)) throw Error("the share of faulty frames must be between 0 and 1");
  }
}

void FaultyWire::push(std::int64_t time_ns, ByteView frame) {
  const bool lost = random_.chance(faults_.lost);
  const bool repeated = random_.chance(faults_.repeated);
  const bool damaged = random_.chance(faults_.damaged) && frame.size() > kHeaders;
  if (lost) {
    ++counts_.lost;
    return;
  }
  if (repeated) {
    ++counts_.repeated;
    const auto later =
        static_cast<std::int64_t>(random_.uniform(2.4, 2.9) * static_cast<double>(kMillisecond));
    sink_(time_ns + later, frame);
  }
  if (!damaged) return sink_(time_ns, frame);
  ++counts_.damaged;
  Bytes bytes(frame.begin(), frame.end());
  const auto bit = random_.bits() % ((bytes.size() - kHeaders) * 8);
  bytes[kHeaders + bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
  sink_(time_ns, bytes);
}

RecordedCapture::RecordedCapture(std::filesystem::path path, RecordingSettings settings, RecordingTruth truth,
                                 const WireFaults& faults)
    : settings_(std::move(settings)),
      truth_(std::move(truth)),
      file_(std::move(path), PcapMode::Replace),
      sorter_([this](std::int64_t ns, ByteView frame) { file_.write(ns, frame); }, kHold),
      wire_(faults, settings_.scanner.seed,
            [this](std::int64_t ns, ByteView frame) { sorter_.push(ns, frame); }),
      plate_(with_port(settings_.scanner.rig.plate.address, kPlatePort),
             hub_for(settings_.scanner.rig.plate.address, kPlatePort),
             [this](std::int64_t ns, ByteView frame) { wire_.push(ns, frame); }) {
  lasers_.resize(settings_.scanner.rig.lasers.size());
  constexpr std::int64_t kBefore = 200 * kMillisecond;  // the plate's readings begin 100 ms before time 0
  for (std::size_t i = 0; i < lasers_.size(); ++i) {
    connect(i, settings_.start_ns - kBefore + static_cast<std::int64_t>(i) * kMillisecond);
  }
}

void RecordedCapture::connect(std::size_t laser, std::int64_t time_ns) {
  auto& connection = lasers_[laser];
  const Address server = with_port(settings_.scanner.rig.lasers[laser].address, kLaserPort);
  const auto port =
      static_cast<std::uint16_t>(kFirstClientPort + laser + lasers_.size() * connection.restarts);
  connection.tcp = std::make_unique<TcpConversation>(
      server, hub_for(server, port), [this](std::int64_t ns, ByteView frame) { wire_.push(ns, frame); });
  connection.tcp->open(time_ns);
  const auto language = settings_.telegrams.language;
  connection.tcp->send(TcpSide::Client, subscription("sEN", language), time_ns + kMillisecond);
  connection.tcp->send(TcpSide::Server, subscription("sEA", language), time_ns + 2 * kMillisecond);
}

void RecordedCapture::write(const HubEvent& event) {
  latest_ns_ = receipt_ns(event);
  std::visit([this](const auto& received) { write(received); }, event);
}

void RecordedCapture::write(const LaserTelegram& telegram) {
  auto& connection = lasers_[telegram.laser];
  const double received = 1e-9 * static_cast<double>(telegram.receipt_ns - settings_.start_ns);
  const auto& device = truth_.lasers[telegram.laser];
  const auto restarts = device.clock.resets_before(received - device.minimum_delay);
  if (restarts != connection.restarts) {
    connection.restarts = restarts;
    connect(telegram.laser, telegram.receipt_ns - 5 * kMillisecond);
  }
  connection.tcp->send(TcpSide::Server, encode_scan_data(telegram.data, settings_.telegrams.language),
                       telegram.receipt_ns);
}

void RecordedCapture::write(const PlateReading& reading) {
  plate_.send(as_bytes(encode_plate_sentence(reading)), reading.receipt_ns);
}

void RecordedCapture::close() {
  for (auto& laser : lasers_) laser.tcp->close(latest_ns_ + 10 * kMillisecond);
  sorter_.finish();
  file_.close();
}

}  // namespace crisp
