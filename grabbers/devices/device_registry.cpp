// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/device_registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include <crisp/error.hpp>

namespace crisp::devices {
namespace {

/// Silences before a device's first item and after its last one, while others were heard.
void count_silences_at_the_ends(std::vector<DeviceStatistics>& all) {
  auto first = std::numeric_limits<std::int64_t>::max();
  auto last = std::numeric_limits<std::int64_t>::min();
  for (const DeviceStatistics& device : all) {
    if (device.items == 0) continue;
    first = std::min(first, device.first_ns);
    last = std::max(last, device.last_ns);
  }
  const auto count = [](DeviceStatistics& device, std::int64_t from, std::int64_t to) {
    const double silence = 1e-9 * static_cast<double>(to - from);
    if (silence <= device.longest_silence) return;
    device.longest_silence = silence;
    device.silence_ns = from;
  };
  for (DeviceStatistics& device : all) {
    if (device.items == 0) continue;
    count(device, first, device.first_ns);
    count(device, device.last_ns, last);
  }
}

}  // namespace

bool is_sick_port(std::uint16_t port) { return port == 2111 || port == 2112; }

DeviceRegistry::DeviceRegistry(const Rig& rig) {
  for (std::size_t i = 0; i < rig.lasers.size(); ++i) {
    add(DeviceKind::Laser, rig.lasers[i].name, rig.lasers[i].address, static_cast<std::uint16_t>(i));
  }
  if (rig.plate.encoder_of) wired_encoder_ = std::make_unique<WiredEncoder>(rig, pauses_.get());
  add(rig.plate);
}

void DeviceRegistry::add(const RigPlate& plate) {
  if (plate.address.ip.empty()) return;
  add(DeviceKind::Plate, plate.name, plate.address, 0);
  known_.back()->line = plate.line;
}

void DeviceRegistry::add(DeviceKind kind, const std::string& name, const Address& address,
                         std::uint16_t index) {
  if (address.ip.empty()) {
    throw Error(name + " has no address in the rig", "give the address that its packets come from");
  }
  const auto ip = parse_ip(address.ip);
  if (!ip) {
    throw Error(fmt::format("the address \"{}\" of {} in the rig is no IP address", address.ip, name),
                "write it like 192.168.0.1");
  }
  for (const auto& other : known_) {
    const bool same_port = other->port == address.port || other->port == 0 || address.port == 0;
    if (other->kind == kind && other->ip == *ip && same_port) {
      throw Error(fmt::format("{} has the same address in the rig as another device", name),
                  "give each device its own, or its own port");
    }
  }
  known_.push_back(std::make_unique<Device>(
      Device{DeviceLog(kind, name, address, index, pauses_.get()), index, kind, *ip, address.port}));
}

DeviceRegistry::Device* DeviceRegistry::known(const FlowKey& key) {
  for (const auto& device : known_) {
    const bool laser = device->kind == DeviceKind::Laser;
    if (device->ip != key.from.ip || (laser && key.transport != Transport::Tcp)) continue;
    const bool sends_to = !laser && device->port == key.to.port;
    if (device->port == 0 || device->port == key.from.port || sends_to) return device.get();
  }
  return nullptr;
}

DeviceRegistry::Device* DeviceRegistry::other(const FlowKey& key, DeviceKind kind) {
  constexpr std::size_t kMax = 256;
  const auto place = std::pair(key.from, kind);
  const auto found = others_.find(place);
  if (found != others_.end()) return found->second.get();
  if (others_.size() >= kMax) return nullptr;
  auto device = std::make_unique<Device>(Device{DeviceLog(kind, "", to_address(key.from), 0, pauses_.get()),
                                                std::nullopt, kind, key.from.ip, key.from.port});
  return others_.emplace(place, std::move(device)).first->second.get();
}

std::vector<DeviceStatistics> DeviceRegistry::statistics() const {
  std::vector<DeviceStatistics> all;
  for (const auto& device : known_) all.push_back(device->log.statistics());
  if (wired_encoder_) all.push_back(wired_encoder_->statistics());
  for (const auto& [place, device] : others_) all.push_back(device->log.statistics());
  count_silences_at_the_ends(all);
  return all;
}

}  // namespace crisp::devices
