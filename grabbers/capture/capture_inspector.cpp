// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/capture_inspector.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <crisp/capture_reader.hpp>

#include "grabbers/capture/capture_report.hpp"
#include "grabbers/capture/captures_in.hpp"
#include "grabbers/capture/pcap_records.hpp"
#include "grabbers/capture/pcapng_blocks.hpp"

namespace crisp::capture {
namespace {

bool recognises(std::string_view head) {
  return PcapRecords::recognises(wire::as_bytes(head)) || PcapngBlocks::recognises(wire::as_bytes(head));
}

bool matches(const Address& of_rig, const Address& found) {
  return of_rig.ip == found.ip && (of_rig.port == 0 || of_rig.port == found.port);
}

void name_devices(CaptureStatistics& statistics, const Rig& rig) {
  for (auto& device : statistics.devices) {
    const bool plate = device.kind == DeviceKind::Plate;
    if (plate && rig.plate.address.ip == device.address.ip) device.name = rig.plate.name;
    for (const auto& laser : rig.lasers) {
      if (!plate && matches(laser.address, device.address)) device.name = laser.name;
    }
  }
}

/// "laser3 (192.168.0.3)" for what the rig has and the capture lacks; nothing for another scanner's capture.
std::vector<std::string> missing_devices(const CaptureStatistics& statistics, const Rig& rig) {
  std::vector<std::string> missing;
  const auto check = [&](const std::string& name, const Address& address) {
    if (!address.ip.empty() && std::ranges::count(statistics.devices, name, &DeviceStatistics::name) == 0)
      missing.push_back(fmt::format("{} ({})", name, address.ip));
  };
  for (const auto& laser : rig.lasers) check(laser.name, laser.address);
  check(rig.plate.name, rig.plate.address);
  return missing.size() == rig.lasers.size() + 1 ? std::vector<std::string>() : missing;
}

Inspection inspect(const std::filesystem::path& file, const Rig& rig) {
  auto statistics = inspect_capture(file, {}, rig.plate);
  name_devices(statistics, rig);
  Inspection inspection;
  inspection.text = to_text(statistics);
  inspection.data = to_json(statistics);
  if (const auto missing = missing_devices(statistics, rig); !missing.empty()) {
    inspection.text += fmt::format("\nnothing of the rig's {}\n", fmt::join(missing, ", "));
    inspection.data["missing"] = missing;
  }
  return inspection;
}

}  // namespace

Inspector capture_inspector() { return {"a capture", recognises, inspect, capture_extensions()}; }

}  // namespace crisp::capture
