// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/capture_inspector.hpp"

#include <crisp/capture_reader.hpp>

#include "grabbers/capture/capture_report.hpp"
#include "grabbers/capture/captures_in.hpp"
#include "grabbers/capture/pcap_records.hpp"
#include "grabbers/capture/pcapng_blocks.hpp"

namespace crisp {
namespace {

bool recognises(std::string_view head) {
  return PcapRecords::recognises(as_bytes(head)) || PcapngBlocks::recognises(as_bytes(head));
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

Inspection inspect(const std::filesystem::path& file, const Rig& rig) {
  auto statistics = inspect_capture(file, {}, rig.plate);
  name_devices(statistics, rig);
  Inspection inspection;
  inspection.text = to_text(statistics);
  inspection.data = to_json(statistics);
  return inspection;
}

}  // namespace

Inspector capture_inspector() { return {"a capture", recognises, inspect, capture_extensions()}; }

}  // namespace crisp
