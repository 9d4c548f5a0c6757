// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "pipeline/data/recordings.hpp"

namespace crisp::write {

/// Which recording a point is of: by the pauses of the encoder readings, and where there are none by silences
/// between a cloud and all that came before it. Points are no measure of it themselves: a filter may leave
/// none for minutes, and they need not come in the order of time.
class RecordingBorders {
 public:
  /// Adds the motion of the plate, in pieces in the order of time, each before the clouds that were taken
  /// meanwhile.
  void add(const PlateTrajectory& plate) { numbers_.add(plate); }

  /// A cloud comes, whose first point was taken at `first` [s since epoch].
  void begin_cloud(double first) {
    if (!numbers_.has_readings() && latest_) numbers_.add_silence(*latest_, first);
  }

  /// @param time  [s since epoch] of a point of the cloud that came last
  /// @return from 0
  std::size_t number(double time) {
    latest_ = std::max(latest_.value_or(time), time);
    return numbers_.of(time);
  }

 private:
  data::RecordingNumbers numbers_;
  std::optional<double> latest_;  // [s since epoch] of all points so far
};

}  // namespace crisp::write
