// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "grabbers/devices/device_log.hpp"
#include "grabbers/devices/network.hpp"
#include "grabbers/devices/wired_encoder.hpp"

namespace crisp::devices {

/// Ports of SICK's devices.
bool is_sick_port(std::uint16_t port);

/// The devices of a capture: those of the rig, by their addresses, and unknown ones, by their telegrams.
class DeviceRegistry {
 public:
  struct Device {
    DeviceLog log;
    std::optional<std::uint16_t> rig_index;  ///< nothing for a device that the rig does not know
    DeviceKind kind = DeviceKind::Laser;
    IpAddress ip{};
    std::uint16_t port = 0;                ///< 0: any
    std::optional<EncoderLine> line = {};  ///< of a plate
  };

  /// @throws Error if an address of the rig is none, or two devices have the same
  explicit DeviceRegistry(const Rig& rig);
  DeviceRegistry() = default;  ///< without a rig: all devices are others
  /// Adds a plate that sends readings of its own; one without an address is left out.
  void add(const RigPlate& plate);

  /// The rig's device from which a flow's packets come, or nullptr. A plate is known by its own port or by
  /// the one that it sends to.
  Device* known(const FlowKey& key);
  /// The device at this address that the rig does not know; made when it is new. nullptr when there are
  /// already more than any network has.
  Device* other(const FlowKey& key, DeviceKind kind);

  /// The plate's encoder where it is wired to a laser; nullptr where it sends readings of its own.
  WiredEncoder* wired_encoder() { return wired_encoder_.get(); }

  std::vector<DeviceStatistics> statistics() const;
  const clocks::Pauses& pauses() const { return *pauses_; }

 private:
  void add(DeviceKind kind, const std::string& name, const Address& address, std::uint16_t index);

  std::unique_ptr<clocks::Pauses> pauses_ = std::make_unique<clocks::Pauses>();
  std::vector<std::unique_ptr<Device>> known_;
  std::unique_ptr<WiredEncoder> wired_encoder_;
  std::map<std::pair<Endpoint, DeviceKind>, std::unique_ptr<Device>> others_;
};

}  // namespace crisp::devices
