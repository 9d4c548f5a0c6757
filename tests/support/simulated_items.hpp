// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include <crisp/hub_item.hpp>

#include "grabbers/simulate/recording.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "grabbers/wire/scan_encoding.hpp"

namespace crisp::test {

/// What a hub receives of a scanner in the office in some seconds, decoded.
inline std::vector<HubItem> simulated_items(double seconds) {
  RecordingSettings settings;
  settings.scanner.duration = seconds;
  RecordingSimulator simulator(settings, office());
  std::vector<HubItem> items;
  while (const auto event = simulator.next()) {
    if (const auto* telegram = std::get_if<LaserTelegram>(&*event)) {
      items.emplace_back(std::make_shared<const Scan>(to_scan(*telegram)));
    } else {
      items.emplace_back(std::get<PlateReading>(*event));
    }
  }
  return items;
}

}  // namespace crisp::test
