// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <crisp/plate_trajectory.hpp>

#include "pipeline/data/play.hpp"

namespace crisp::simulate {

/// Motion of the plate.
enum class MotionKind {
  constant,     ///< at `max_rate`
  varying,      ///< smoothly between `min_rate` and `max_rate`, at random
  reversal,     ///< to and fro between −max_rate and max_rate
  stop_and_go,  ///< turns at `max_rate`, stops, turns on
};

struct MotionSettings {
  MotionKind kind = MotionKind::varying;
  double min_rate = 0;     ///< [Hz] slowest of `varying`
  double max_rate = 2;     ///< [Hz]
  double change_time = 1;  ///< [s] how long a change of speed takes
  double hold_time = 1;    ///< [s] how long a speed is held (`varying` holds none)
};

/// The true motion of the plate: knots of a rate, joined by smooth steps u²(3 − 2u), so that the acceleration
/// is continuous. Before the first knot and after the last the rate stays as it is there.
class Motion {
 public:
  struct Knot {
    double time;  ///< [s]
    double rate;  ///< [rad/s]
  };

  /// @param knots        ascending in time, at least one
  /// @param first_angle  [rad] φ at the first knot
  /// @throws Error       if there are none, or their times do not ascend
  explicit Motion(std::vector<Knot> knots, double first_angle = 0);

  /// The plate at any time [s]: always known. (Optional as the sensor model requires it.)
  std::optional<PlateState> at(double t) const;

 private:
  PlateState between(std::size_t from, double t) const;
  data::Play play_after(std::size_t from, double t) const;

  std::vector<Knot> knots_;
  std::vector<double> angles_;     ///< [rad] φ at each knot
  std::vector<data::Play> plays_;  ///< at each knot
};

/// Draws a motion that covers [0, duration] seconds. The first angle is drawn too, in a revolution.
/// @throws Error if a rate, time or duration makes no sense
Motion make_motion(const MotionSettings& settings, double duration, std::uint64_t seed);

}  // namespace crisp::simulate
