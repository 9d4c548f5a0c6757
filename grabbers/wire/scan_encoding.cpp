// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/scan_encoding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <crisp/error.hpp>

#include "grabbers/wire/cola.hpp"
#include "pipeline/data/degree.hpp"

namespace crisp::wire {
namespace {

constexpr double kMillimetres = 1e3;
constexpr double kMaxRaw = std::numeric_limits<std::uint16_t>::max();

Error beyond_telegram(float value) {
  return Error(fmt::format("a scan has a value of {}, which a telegram cannot encode", value),
               "check the unit of the recording's ranges and remissions, or leave such scans out");
}

/// The least whole scale under which all values fit into `most`.
float scale_for(const std::vector<float>& values, double factor, double most) {
  float largest = 0;
  for (const float value : values) {
    if (!(value >= 0)) throw beyond_telegram(value);
    largest = std::max(largest, value);
  }
  const double scale = std::max(1.0, std::ceil(largest * factor / most - 1e-6));
  if (!(scale <= kMaxRaw)) throw beyond_telegram(largest);
  return static_cast<float>(scale);
}

ChannelBlock channel(const Scan& scan, std::string name, const std::vector<float>& values, double factor,
                     double most) {
  ChannelBlock block{.name = std::move(name), .scale = scale_for(values, factor, most)};
  block.start_angle =
      static_cast<std::int32_t>(std::lround(scan.start_angle / data::kDegree * kUnitsPerDegree));
  block.angle_step =
      static_cast<std::uint16_t>(std::lround(scan.angle_step / data::kDegree * kUnitsPerDegree));
  block.raw.reserve(values.size());
  for (const float value : values) {
    block.raw.push_back(static_cast<std::uint16_t>(std::lround(value * factor / block.scale)));
  }
  return block;
}

void check_angles(const Scan& scan) {
  constexpr double kMax = 720 * data::kDegree;
  const bool start = std::abs(scan.start_angle) <= kMax;
  const bool step = scan.angle_step >= 0 && scan.angle_step * kUnitsPerDegree / data::kDegree < kMaxRaw;
  if (start && step) return;
  throw Error(
      fmt::format("a scan begins at {:g} rad and has steps of {:g} rad, which a telegram cannot encode",
                  scan.start_angle, scan.angle_step),
      "check the unit of the recording's angles; a scan begins within two turns and its angles ascend");
}

/// Whichever the dialect: CoLa-A takes up to five characters for a value.
void check_size(const Scan& scan) {
  constexpr std::size_t kCharacters = 5, kRest = 4096;
  std::size_t values = 0;
  for (const Echo& echo : scan.echoes) values += echo.ranges.size() + echo.remissions.size();
  if (values * kCharacters + kRest <= kLargestColaPayload) return;
  throw Error(fmt::format("a scan has {} values, more than a telegram can hold", values),
              fmt::format("give scans of {} values at most", (kLargestColaPayload - kRest) / kCharacters));
}

}  // namespace

ScanData to_scan_data(const Scan& scan) {
  check_angles(scan);
  check_size(scan);
  ScanData data;
  data.serial_number = scan.serial_number;
  data.device_status = scan.device_status;
  data.telegram_counter = scan.telegram_counter;
  data.scan_counter = scan.scan_counter;
  data.scan_time_us = scan.scan_time_us;
  data.transmission_time_us = scan.transmission_time_us;
  data.scan_frequency = static_cast<std::uint32_t>(std::lround(scan.scan_frequency * 100));
  for (const ScanEncoder& encoder : scan.encoders) data.encoders.push_back({encoder.position, encoder.speed});
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    const Echo& echo = scan.echoes[i];
    const std::string number = std::to_string(i + 1);
    data.channels16.push_back(channel(scan, "DIST" + number, echo.ranges, kMillimetres, kMaxRaw));
    if (echo.remissions.empty()) continue;
    const bool narrow = std::ranges::max(echo.remissions) <= 255;
    auto& remissions = narrow ? data.channels8 : data.channels16;
    remissions.push_back(channel(scan, "RSSI" + number, echo.remissions, 1, kMaxRaw));
  }
  return data;
}

}  // namespace crisp::wire
