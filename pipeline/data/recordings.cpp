// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/recordings.hpp"

#include <algorithm>

namespace crisp {

std::vector<Recording> recordings_of(const PlateTrajectory& plate) {
  std::vector<Recording> all;
  for (const double time : plate.times()) {
    if (all.empty() || time - all.back().end > kPause) {
      const auto zero = std::ranges::count_if(plate.new_zeros(), [&](double at) { return at <= time; });
      all.push_back({.begin = time, .end = time, .zero = static_cast<std::size_t>(zero)});
    }
    all.back().end = time;
  }
  return all;
}

RecordingNumbers::RecordingNumbers(const PlateTrajectory& plate) {
  const auto all = recordings_of(plate);
  for (std::size_t k = 1; k < all.size(); ++k) borders_.push_back((all[k - 1].end + all[k].begin) / 2);
}

std::size_t RecordingNumbers::of(double time) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(borders_, time) - borders_.begin());
}

}  // namespace crisp
