// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/upright.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/data/degree.hpp"

namespace crisp {

bool is_in_plane(const Sample& sample) {
  return std::ranges::all_of(sample.beams.mirror_angle, [](float angle) {
    return std::abs(std::abs(static_cast<double>(angle)) - std::numbers::pi / 2) < 0.5 * kDegree;
  });
}

Sample spread_upright(const Sample& sample, double spread) {
  Sample result = sample;
  for (std::size_t i = 0; i < result.beams.size(); ++i) {
    const double turns = static_cast<double>(i + 1) * std::numbers::phi;  // Weyl's sequence: no two alike
    const double angle = spread * (2 * (turns - std::floor(turns)) - 1);
    result.beams.mirror_angle[i] += static_cast<float>(angle);
    result.beams.range[i] = static_cast<float>(static_cast<double>(result.beams.range[i]) / std::cos(angle));
  }
  return result;
}

}  // namespace crisp
