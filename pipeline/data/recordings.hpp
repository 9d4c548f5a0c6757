// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <crisp/plate_trajectory.hpp>

namespace crisp::data {

/// [s] A silence after which what comes is another recording: the scanner may have been carried elsewhere,
/// and its clocks have nothing in common with those before. One recording too many costs little.
inline constexpr double kPause = 5;

/// Whether a silence [s] divides two recordings.
inline bool is_pause(double silence) { return silence > kPause; }

/// A stretch of time in which the scanner stood in one place.
struct Recording {
  double begin = 0;      ///< [s since epoch] first encoder reading
  double end = 0;        ///< [s since epoch] last one
  std::size_t zero = 0;  ///< of the encoder: recordings with the same one have angles in common
};

/// Splits a trajectory at pauses of the encoder readings, in the order of time.
std::vector<Recording> recordings_of(const PlateTrajectory& plate);

/// Which recording a time belongs to.
class RecordingNumbers {
 public:
  RecordingNumbers() = default;  ///< one recording, until there are pauses
  explicit RecordingNumbers(const PlateTrajectory& plate) { add(plate); }

  /// Adds encoder readings, later than those before.
  void add(const PlateTrajectory& plate);
  /// Adds a silence, later than the pauses before [s since epoch]; a short one is no pause.
  void add_silence(double begin, double end);

  /// @return from 0; times in a pause belong to the nearer recording
  std::size_t of(double time) const;
  std::size_t count() const { return borders_.size() + 1; }
  bool has_readings() const { return end_.has_value(); }

 private:
  std::vector<double> borders_;  // [s since epoch] the middles of the pauses
  std::optional<double> end_;    // [s since epoch] of the encoder readings
};

}  // namespace crisp::data
