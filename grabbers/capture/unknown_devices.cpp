// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/unknown_devices.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "grabbers/capture/capture_report.hpp"

namespace crisp::capture {
namespace {

/// The titles of the devices that the rig does not have, each once, in the order of the captures.
std::vector<std::string> titles_of_unknown_devices(const std::vector<CaptureStatistics>& captures,
                                                   std::initializer_list<DeviceKind> kinds) {
  std::vector<std::string> titles;
  for (const auto& capture : captures) {
    for (const auto& device : capture.devices) {
      const bool requested = device.name.empty() && std::ranges::find(kinds, device.kind) != kinds.end();
      if (requested && std::ranges::find(titles, title(device)) == titles.end())
        titles.push_back(title(device));
    }
  }
  return titles;
}

}  // namespace

std::string unknown_devices(const std::vector<CaptureStatistics>& captures) {
  return fmt::format(
      "{}", fmt::join(titles_of_unknown_devices(captures, {DeviceKind::Laser, DeviceKind::Plate}), ", "));
}

std::vector<std::string> caveats_of_addresses(const std::vector<CaptureStatistics>& captures) {
  std::map<std::string, std::uint64_t> items;  // of the rig's devices, by title
  std::vector<std::string> caveats;
  for (const auto& capture : captures) {
    for (const auto& device : capture.devices) items[title(device)] += device.items;
  }
  if (captures.empty()) return caveats;
  for (const auto& device : captures.front().devices) {  // the rig's are in each
    if (device.name.empty() || items[title(device)] > 0) continue;
    const auto others = titles_of_unknown_devices(captures, {device.kind});
    if (others.empty()) continue;
    caveats.push_back(fmt::format(
        "there is no data of {}, but of an unknown {}; correct the addresses and ports in the rig",
        title(device), fmt::join(others, ", a ")));
  }
  return caveats;
}

}  // namespace crisp::capture
