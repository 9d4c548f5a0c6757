// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <crisp/capture_reader.hpp>
#include <crisp/hub_item.hpp>

#include "grabbers/capture/tcp_stream.hpp"
#include "grabbers/devices/device_registry.hpp"
#include "grabbers/wire/plate_framer.hpp"

namespace crisp::capture {

/// One direction of one conversation between two ends: finds out what it carries, and hands telegrams and
/// readings to the device that sent them.
class FlowDecoder final : public StreamSink {
 public:
  using Give = std::function<void(HubItem)>;

  /// @param known the rig's device at the flow's beginning, or nullptr
  /// @param give  takes what a device of the rig measured
  FlowDecoder(const devices::FlowKey& key, devices::DeviceRegistry& devices,
              devices::DeviceRegistry::Device* known, const CaptureSettings& settings, const Give& give);

  void take(const devices::TransportPacket& packet, std::int64_t time_ns);
  void expire(std::int64_t now_ns);
  /// The capture ends, or the flow is forgotten: what is incomplete is lost, and the device learns all
  /// counts.
  void finish();

  /// [ns] No item still to come from what is here since `earliest_ns` was received earlier. Nothing if
  /// nothing is here. A telegram's begin that has waited for longer does not count: it is given up.
  std::optional<std::int64_t> waiting_since(std::int64_t earliest_ns) const;
  std::int64_t last_ns() const { return last_ns_; }
  bool is_of_rig() const { return device_ != nullptr && device_->rig_index.has_value(); }

 private:
  enum class Speech : std::uint8_t { Unknown, Cola, Plate, Nothing };

  void data(wire::ByteView bytes, std::int64_t arrival_ns) override;
  void gap() override;
  void repeated(wire::ByteView bytes) override;

  std::unique_ptr<wire::PlateFramer> plate_framer() const;
  bool trust(const devices::TransportPacket& packet, std::int64_t time_ns);
  void take_doubtful();
  void take_trusted(const devices::TransportPacket& packet, std::int64_t time_ns);
  void take_frame(const wire::ColaFrame& frame);
  void take_reading(const PlateReading& reading);
  bool settle(Speech speech);
  void report();

  devices::FlowKey key_;
  devices::DeviceRegistry& devices_;
  devices::DeviceRegistry::Device* device_ = nullptr;
  CaptureSettings settings_;
  const Give& give_;
  Speech speech_ = Speech::Unknown;
  TcpStream tcp_;
  std::unique_ptr<wire::ColaFramer> cola_;
  std::unique_ptr<wire::PlateFramer> plate_;
  std::size_t unconvincing_bytes_ = 0;
  struct Doubtful {
    devices::TransportPacket packet;
    wire::Bytes payload;
    std::int64_t time_ns;
  };
  std::vector<Doubtful> doubtful_;  ///< with wrong checksums, before any right one came
  std::uint64_t right_checksums_ = 0, wrong_checksums_ = 0, dropped_ = 0, cut_short_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace crisp::capture
