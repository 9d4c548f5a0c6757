// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/filter/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <crisp/error.hpp>

namespace crisp::filter {
namespace {

bool is_within(const Limits& limits, double value) {
  return limits.empty() || (value >= limits[0] && value <= limits[1]);
}

}  // namespace

void check_limits(const Limits& limits, const std::string& name) {
  if (limits.size() == 1) throw Error(name + " has one limit", "give the smallest and the largest value");
  if (limits.size() == 2 && limits[0] > limits[1]) {
    throw Error(fmt::format("{}: [{:g}, {:g}] is empty", name, limits[0], limits[1]),
                "give the smaller limit first");
  }
}

Cloud crop(const Cloud& cloud, const CropLimits& limits) {
  Cloud kept;
  kept.header = cloud.header;
  for (const Point& point : cloud) {
    const auto x = static_cast<double>(point.x);
    const auto y = static_cast<double>(point.y);
    const auto z = static_cast<double>(point.z);
    const bool keep = is_within(limits.x, x) && is_within(limits.y, y) && is_within(limits.z, z) &&
                      is_within(limits.distance, std::hypot(x, y, z));
    if (keep) kept.push_back(point);
  }
  return kept;
}

Measurements within(const Measurements& beams, const RangeLimits& limits) {
  const auto requested = [&](std::uint16_t laser) {
    return limits.lasers.empty() || std::count(limits.lasers.begin(), limits.lasers.end(), laser) > 0;
  };
  Measurements kept;
  kept.epoch_ns = beams.epoch_ns;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const bool keep = is_within(limits.range, static_cast<double>(beams.range[i])) &&
                      is_within(limits.mirror_angle, static_cast<double>(beams.mirror_angle[i])) &&
                      is_within(limits.remission, static_cast<double>(beams.remission[i])) &&
                      requested(beams.laser[i]);
    if (keep) kept.append(beams, i);
  }
  return kept;
}

}  // namespace crisp::filter
