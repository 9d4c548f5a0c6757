// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace crisp::statistics {

/// Quantile group of each value, with about equally many values per group. Equal values share a group.
inline std::vector<std::uint32_t> groups_of(std::span<const float> values, std::size_t count) {
  std::vector<float> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  std::vector<float> ends;
  for (std::size_t g = 1; g < count; ++g) ends.push_back(sorted[g * sorted.size() / count]);
  std::vector<std::uint32_t> groups;
  groups.reserve(values.size());
  for (const float value : values) {
    groups.push_back(static_cast<std::uint32_t>(std::ranges::upper_bound(ends, value) - ends.begin()));
  }
  return groups;
}

}  // namespace crisp::statistics
