// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "pipeline/data/recordings.hpp"

namespace crisp {

/// Which recording a point is of: by the pauses of the encoder readings, and where there are none by silences
/// between a cloud and all that came before it. Points are no measure of it themselves: a filter may leave
/// none for minutes, and they need not come in the order of time.
class RecordingBorders {
 public:
  /// Adds the motion of the plate, in pieces in the order of time, each before the clouds that were taken
  /// meanwhile.
  void add(const PlateTrajectory& plate) {
    for (const Recording& recording : recordings_of(plate)) {
      if (end_ && recording.begin - *end_ > kPause) borders_.push_back((*end_ + recording.begin) / 2);
      end_ = recording.end;
    }
  }

  /// A cloud comes, whose first point was taken at `first` [s since epoch].
  void begin_cloud(double first) {
    if (!end_ && latest_ && first - *latest_ > kPause) borders_.push_back((*latest_ + first) / 2);
  }

  /// @param time  [s since epoch] of a point of the cloud that came last
  /// @return from 0
  std::size_t number(double time) {
    latest_ = std::max(latest_.value_or(time), time);
    return static_cast<std::size_t>(std::ranges::upper_bound(borders_, time) - borders_.begin());
  }

 private:
  std::vector<double> borders_;   // [s since epoch] the middles of the pauses
  std::optional<double> end_;     // [s since epoch] of the encoder readings
  std::optional<double> latest_;  // [s since epoch] of all points so far
};

}  // namespace crisp
