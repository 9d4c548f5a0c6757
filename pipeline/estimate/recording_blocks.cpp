// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/recording_blocks.hpp"

#include <algorithm>
#include <map>

namespace crisp {

std::vector<std::uint32_t> recording_blocks(const Measurements& beams) {
  constexpr double kLong = 0.1;  // [s]
  constexpr double kFewest = 100;
  const auto [first, last] = std::ranges::minmax(beams.time);
  const double length = std::max(1e-9, std::min(kLong, (last - first) / kFewest));
  const auto piece = [&, first = first](double time) {
    return static_cast<std::int64_t>((time - first) / length);
  };
  std::map<std::int64_t, std::uint32_t> numbers;  // without the pieces of pauses
  for (const double time : beams.time) numbers.try_emplace(numbers.end(), piece(time), 0);
  std::uint32_t next = 0;
  for (auto& [at, number] : numbers) number = next++;
  std::vector<std::uint32_t> blocks;
  blocks.reserve(beams.size());
  auto at = numbers.begin();
  for (const double time : beams.time) {
    if (at->first != piece(time)) at = numbers.find(piece(time));
    blocks.push_back(at->second);
  }
  return blocks;
}

}  // namespace crisp
