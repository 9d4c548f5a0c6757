// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <vector>

#include "pipeline/estimate/sample.hpp"

namespace crisp::calibrate {

/// The measurements of the last seconds with the plate's motion beneath them: batches and pieces that
/// overlap, as they come from a live pipeline.
class SlidingWindow {
 public:
  struct Batch {
    std::shared_ptr<const Measurements> beams;
    std::shared_ptr<const PlateTrajectory> plate;
  };

  explicit SlidingWindow(double seconds) : seconds_(seconds) {}

  /// Forgets what is older than `seconds` before it.
  void add(Batch batch);
  double duration() const;  ///< [s] from the first beam to the last
  double latest() const;    ///< [s since the epoch] of the last beam; 0 without any

  /// A snapshot of the current batches.
  std::vector<Batch> batches() const { return {batches_.begin(), batches_.end()}; }

 private:
  double seconds_;
  std::deque<Batch> batches_;
};

/// About `most` of the batches' beams, each as likely to be taken as any other, over one trajectory.
///
/// Where pieces overlap the later one counts only behind the earlier: live clocks are known better each time,
/// so that the same reading has times in them which differ by microseconds, and two of it would be a jerk.
///
/// @param plate  receives the trajectory, which the sample refers to
estimate::Sample sample_of(const std::vector<SlidingWindow::Batch>& batches, std::size_t most,
                           PlateTrajectory& plate);

}  // namespace crisp::calibrate
