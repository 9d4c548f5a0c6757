// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/strangers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "grabbers/capture/capture_report.hpp"

namespace crisp {
namespace {

/// The titles of the devices that the rig does not have, each once, in the order of the captures.
std::vector<std::string> titles_of_strangers(const std::vector<CaptureStatistics>& captures,
                                             std::initializer_list<DeviceKind> kinds) {
  std::vector<std::string> titles;
  for (const auto& capture : captures) {
    for (const auto& device : capture.devices) {
      const bool wanted = device.name.empty() && std::ranges::find(kinds, device.kind) != kinds.end();
      if (wanted && std::ranges::find(titles, title(device)) == titles.end()) titles.push_back(title(device));
    }
  }
  return titles;
}

}  // namespace

std::string strangers(const std::vector<CaptureStatistics>& captures) {
  return fmt::format("{}",
                     fmt::join(titles_of_strangers(captures, {DeviceKind::Laser, DeviceKind::Plate}), ", "));
}

std::vector<std::string> doubts_of_addresses(const std::vector<CaptureStatistics>& captures) {
  std::map<std::string, std::uint64_t> items;  // of the rig's devices, by title
  std::vector<std::string> doubts;
  for (const auto& capture : captures) {
    for (const auto& device : capture.devices) items[title(device)] += device.items;
  }
  if (captures.empty()) return doubts;
  for (const auto& device : captures.front().devices) {  // the rig's are in each
    if (device.name.empty() || items[title(device)] > 0) continue;
    const auto others = titles_of_strangers(captures, {device.kind});
    if (others.empty()) continue;
    doubts.push_back(
        fmt::format("nothing came of {}, but there is a {}, which the rig does not have; correct the "
                    "addresses in the rig",
                    title(device), fmt::join(others, ", a ")));
  }
  return doubts;
}

}  // namespace crisp
