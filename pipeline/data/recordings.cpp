// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/recordings.hpp"

#include <algorithm>

namespace crisp::data {

std::vector<Recording> recordings_of(const PlateTrajectory& plate) {
  std::vector<Recording> all;
  for (const double time : plate.times()) {
    if (all.empty() || is_pause(time - all.back().end)) {
      const auto zero = std::ranges::count_if(plate.new_zeros(), [&](double at) { return at <= time; });
      all.push_back({.begin = time, .end = time, .zero = static_cast<std::size_t>(zero)});
    }
    all.back().end = time;
  }
  return all;
}

void RecordingNumbers::add(const PlateTrajectory& plate) {
  for (const Recording& recording : recordings_of(plate)) {
    if (end_) add_silence(*end_, recording.begin);
    end_ = recording.end;
  }
}

void RecordingNumbers::add_silence(double begin, double end) {
  if (is_pause(end - begin)) borders_.push_back((begin + end) / 2);
}

std::size_t RecordingNumbers::of(double time) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(borders_, time) - borders_.begin());
}

}  // namespace crisp::data
