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
  simulate::RecordingSettings settings;
  settings.scanner.duration = seconds;
  simulate::RecordingSimulator simulator(settings, simulate::office());
  std::vector<HubItem> items;
  while (const auto event = simulator.next()) {
    if (const auto* telegram = std::get_if<simulate::LaserTelegram>(&*event)) {
      items.emplace_back(std::make_shared<const Scan>(simulate::to_scan(*telegram)));
    } else {
      items.emplace_back(std::get<PlateReading>(*event));
    }
  }
  return items;
}

}  // namespace crisp::test
