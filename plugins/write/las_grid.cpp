// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/las_grid.hpp"

#include <cmath>

namespace crisp::write {

std::optional<std::array<std::int32_t, 3>> LasGrid::numbers(const std::array<double, 3>& point) const {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  std::array<std::int32_t, 3> numbers{};
  for (std::size_t i = 0; i < point.size(); ++i) {
    const double rounded = std::round((point[i] - offset[i]) / scale);
    if (!(std::abs(rounded) <= kMost)) return {};
    numbers[i] = static_cast<std::int32_t>(rounded);
  }
  return numbers;
}

LasGrid grid_near(const std::array<double, 3>& point) {
  constexpr double kOffsets = 100'000;  // [m] 0 for all but maps
  LasGrid grid;
  for (std::size_t i = 0; i < point.size(); ++i) grid.offset[i] = kOffsets * std::round(point[i] / kOffsets);
  return grid;
}

std::optional<LasGrid> wider_grid(const LasGrid& grid, const Extent& extent) {
  constexpr double kUsed = 0.75;  // of the reach: a cloud that grows is not moved again for each point
  constexpr std::array kScales = {1e-4, 1e-3, 1e-2, 0.1, 1.0};  // [m]
  double half = 0;
  LasGrid wider;
  for (std::size_t i = 0; i < wider.offset.size(); ++i) {
    half = std::max(half, (extent.most[i] - extent.least[i]) / 2);
    wider.offset[i] = std::round((extent.most[i] + extent.least[i]) / 2);
  }
  for (const double scale : kScales) {
    wider.scale = scale;
    if (scale >= grid.scale && half <= kUsed * wider.reach()) return wider;
  }
  return {};
}

}  // namespace crisp::write
