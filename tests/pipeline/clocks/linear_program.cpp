// SPDX-License-Identifier: BSD-3-Clause
#include "tests/pipeline/clocks/linear_program.hpp"

#include <algorithm>
#include <cstddef>

namespace crisp::test {
namespace {

using namespace crisp::clocks;

/// Index of the first stamp that a line of this slope touches from below.
std::size_t touched_by(std::span<const Stamp> stamps, double slope) {
  const auto lower = [slope](const Stamp& a, const Stamp& b) {
    return a.lead - b.lead < slope * (a.device - b.device);
  };
  return static_cast<std::size_t>(std::min_element(stamps.begin(), stamps.end(), lower) - stamps.begin());
}

ClockLine line_through(const Stamp& stamp, double slope, double center) {
  return {.center = center, .at_center = stamp.lead + slope * (center - stamp.device), .slope = slope};
}

}  // namespace

ClockLine line_by_linear_program(std::span<const Stamp> stamps, double center) {
  if (stamps.front().device == stamps.back().device) {
    return line_through(stamps[touched_by(stamps, 0)], 0, center);
  }
  // height(slope) = min over i of lead_i + slope · (center − device_i) is concave; a stamp that supports the
  // line left of the center shows that a steeper line stands higher, one right of it the contrary.
  std::size_t left = touched_by(stamps, -kMaxSkew);
  if (stamps[left].device > center) return line_through(stamps[left], -kMaxSkew, center);
  std::size_t right = touched_by(stamps, kMaxSkew);
  if (stamps[right].device <= center) return line_through(stamps[right], kMaxSkew, center);
  while (true) {
    const double slope =
        (stamps[right].lead - stamps[left].lead) / (stamps[right].device - stamps[left].device);
    const auto between = stamps.subspan(left, right - left + 1);
    const std::size_t touched = left + touched_by(between, slope);
    const double below =
        stamps[left].lead - stamps[touched].lead - slope * (stamps[left].device - stamps[touched].device);
    if (touched == left || touched == right || below <= 0) {
      return line_through(stamps[left], slope, center);
    }
    (stamps[touched].device <= center ? left : right) = touched;
  }
}

}  // namespace crisp::test
