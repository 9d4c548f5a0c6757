// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/recording_blocks.hpp"

#include <algorithm>

namespace crisp {

std::vector<std::uint32_t> recording_blocks(const Measurements& beams) {
  constexpr double kLong = 0.1;  // [s]
  constexpr double kFewest = 100;
  const auto [first, last] = std::ranges::minmax(beams.time);
  const double length = std::max(1e-9, std::min(kLong, (last - first) / kFewest));
  std::vector<std::uint32_t> blocks;
  blocks.reserve(beams.size());
  for (const double time : beams.time) blocks.push_back(static_cast<std::uint32_t>((time - first) / length));
  return blocks;
}

}  // namespace crisp
