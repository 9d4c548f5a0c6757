// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/outliers.hpp"

#include <algorithm>

#include "pipeline/statistics/random_stream.hpp"

namespace crisp::study {

void add_outliers(Measurements& beams, double share, std::uint64_t seed) {
  constexpr double kBefore = 0.8;   // of the outliers
  constexpr double kNearest = 0.3;  // [m]
  constexpr double kBehind = 5;     // [m]
  statistics::RandomStream random(seed, "outliers");
  for (float& range : beams.range) {
    if (!random.chance(share)) continue;
    const double hit = std::max(kNearest, double{range});
    const bool before = random.chance(kBefore);
    range = static_cast<float>(before ? random.uniform(kNearest, hit) : hit + random.uniform(0, kBehind));
  }
}

}  // namespace crisp::study
