// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <crisp/cloud.hpp>
#include <crisp/plate_trajectory.hpp>

namespace crisp {

/// What part of a turn is one cloud.
struct RevolutionSettings {
  double turns = 1;     ///< of the plate, in one cloud; 0.5 is enough for lasers that see to both sides
  double longest = 10;  ///< [s] of points in one cloud, if the plate does not turn so far
};

/// Gathers points into clouds of a revolution of the plate each, or a part of one. A cloud ends when the
/// plate has turned so far from where it was when the cloud began, forwards or back: to the point, whichever
/// scan that is in.
class Revolutions {
 public:
  /// Receives each complete cloud.
  using Give = std::function<void(std::shared_ptr<const Cloud>)>;

  /// @param give  called with each complete cloud, within add() and finish()
  Revolutions(const RevolutionSettings& settings, Give give) : settings_(settings), give_(std::move(give)) {}

  /// @param points  of a scan, times on the epoch of `plate`
  /// @param plate   φ(t) over them; where it is unknown, no cloud ends
  void add(const Cloud& points, const PlateTrajectory& plate);
  /// Gives the remaining points.
  void finish();

 private:
  bool ends_at(double time, const PlateTrajectory& plate);
  void add(const Point& point, const PlateTrajectory& plate);
  bool others_follow() const;
  void give_current();

  RevolutionSettings settings_;
  Give give_;
  std::shared_ptr<Cloud> current_, next_;
  double begin_ = 0;                   ///< [s] of the current cloud
  std::optional<double> begin_angle_;  ///< [rad] of the plate then
  std::optional<double> end_;          ///< [s] of the current cloud, once it is known
  double end_angle_ = 0;               ///< [rad]
  std::vector<bool> seen_, gone_on_;   ///< by laser: in the current cloud, and in the next
};

}  // namespace crisp
