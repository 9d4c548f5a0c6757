// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <crisp/plate_trajectory.hpp>
#include <crisp/rig.hpp>

namespace crisp::table {

/// The angles of an actuator as its recording has them, rounded to the steps of the rig's encoder and
/// continued over whole turns.
class ActuatorAngles {
 public:
  explicit ActuatorAngles(RigPlate plate) : plate_(std::move(plate)) {}

  /// @param reported  [rad] the way in which the encoder counts
  /// @return [rad] counter-clockwise seen from +z, less than half a turn from the one before
  double unwrap(double reported);
  /// Adds an angle that was unwrapped, unless another is known at that time or later.
  /// @param time  [s since the epoch]
  void add(double time, double angle);

  /// The encoder's count at an angle that was unwrapped, modulo 2^32.
  std::uint32_t count_at(double angle) const;
  /// @throws Error if there are fewer than two angles at different times
  PlateTrajectory trajectory(std::int64_t epoch_ns, double max_gap) const;
  /// Angles before this time [s since the epoch] are no longer part of trajectory(), but for the last three.
  void forget_before(double time);
  std::size_t size() const { return times_.size(); }

 private:
  RigPlate plate_;
  std::optional<double> last_;
  std::vector<double> times_;
  std::vector<double> angles_;
};

}  // namespace crisp::table
