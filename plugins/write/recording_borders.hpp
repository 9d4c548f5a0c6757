// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>

#include "pipeline/data/recordings.hpp"

namespace crisp {

/// Which recording a point is of, while clouds come: by the pauses of the plate's readings, and without a
/// plate by a silence between a cloud and all that came before it. Points are no measure of it themselves: a
/// filter may leave none for minutes, and they need not come in the order of time.
class RecordingBorders {
 public:
  /// A cloud comes.
  ///
  /// @param plate  how the plate turned meanwhile; null where nothing says so
  /// @param first  [s since epoch] of its first point
  void begin_cloud(const std::shared_ptr<const PlateTrajectory>& plate, double first) {
    if (!plate) {
      before_ += latest_ && first - *latest_ > kPause ? 1 : 0;
    } else if (plate != plate_) {
      if (plate_) before_ += numbers_->count() - 1 + (plate->begin() - plate_->end() > kPause ? 1 : 0);
      plate_ = plate;
      numbers_.emplace(*plate);
    }
  }

  /// @param time  [s since epoch] of a point of the cloud that came last
  /// @return from 0
  std::size_t number(double time) {
    latest_ = std::max(latest_.value_or(time), time);
    return before_ + (numbers_ ? numbers_->of(time) : 0);
  }

 private:
  std::size_t before_ = 0;  // recordings before the plate's first
  std::shared_ptr<const PlateTrajectory> plate_;
  std::optional<RecordingNumbers> numbers_;  // of plate_
  std::optional<double> latest_;             // [s since epoch] of all points so far
};

}  // namespace crisp
