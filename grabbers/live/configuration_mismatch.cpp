// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/configuration_mismatch.hpp"

#include <fmt/format.h>

#include <cmath>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp::live {
namespace {

using data::kDegree;

constexpr double kRounding = 2e-4 * kDegree;  // of angles in telegrams
constexpr double kHertz = 0.01;               // likewise of frequencies

}  // namespace

void check(const SickConfiguration& configuration) {
  const auto& range = configuration.output_range;
  if (range.empty()) return;
  const bool good =
      range.size() == 2 && range[0] < range[1] && range[0] >= -360 * kDegree && range[1] <= 360 * kDegree;
  if (!good) throw Error("the output range is no range", "give its first and last angle: [-45deg, 225deg]");
}

std::string difference(const SickConfiguration& requested, const Scan& scan) {
  std::string found;
  const auto add = [&](std::string what) { found += (found.empty() ? "" : ", ") + std::move(what); };
  if (requested.frequency && std::abs(*requested.frequency - scan.scan_frequency) > kHertz) {
    add(fmt::format("{:g} Hz instead of {:g} Hz", scan.scan_frequency, *requested.frequency));
  }
  if (requested.resolution && std::abs(*requested.resolution - scan.angle_step) > kRounding) {
    add(fmt::format("{:.4g} deg from beam to beam instead of {:.4g} deg", scan.angle_step / kDegree,
                    *requested.resolution / kDegree));
  }
  const Echo& echo = scan.echoes.front();
  if (requested.remission && *requested.remission == echo.remissions.empty()) {
    add(*requested.remission ? "no remissions" : "remissions that were not requested");
  }
  if (!requested.output_range.empty()) {
    const double last = scan.start_angle + scan.angle_step * static_cast<double>(echo.ranges.size() - 1);
    const bool begins = std::abs(scan.start_angle - requested.output_range[0]) < scan.angle_step + kRounding;
    const bool ends = std::abs(last - requested.output_range[1]) < scan.angle_step + kRounding;
    if (!begins || !ends) {
      add(fmt::format("beams from {:.4g} to {:.4g} deg", scan.start_angle / kDegree, last / kDegree));
    }
  }
  return found;
}

}  // namespace crisp::live
