// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>

namespace crisp::devices {

/// Beams of a rotating head and the trajectory that covers them.
struct HeadPiece {
  PlateTrajectory plate;
  std::vector<Measurements> beams;

  /// Gives the trajectory, and then the beams.
  /// @param out  Outputs of a stage
  template <class Out>
  void give_to(Out& out) && {
    out.give(std::move(plate));
    for (Measurements& some : beams) out.give(std::move(some));
  }
};

/// A 3D laser as lasers with a fixed beam each: the azimuth of its head is the plate's angle. Hands out its
/// beams in pieces, so that memory does not grow with the recording.
class RotatingHead {
 public:
  /// @param epoch_ns  [ns since the Unix epoch] zero of all times
  /// @param max_gap   [s] longest silence of the azimuths to interpolate across
  RotatingHead(std::int64_t epoch_ns, double max_gap) : epoch_ns_(epoch_ns), max_gap_(max_gap) {}

  /// Adds an azimuth of the head unless a later one, or one just before, is known.
  /// @param time     [s since the epoch]
  /// @param azimuth  [rad] counter-clockwise seen from +z, less than half a turn from the one before
  void add_azimuth(double time, double azimuth);
  /// Adds beams in the order of their times; none is no harm.
  void add(Measurements beams);

  /// The oldest beams, if several seconds are held.
  std::optional<HeadPiece> take_piece();
  /// All beams that are left.
  HeadPiece take_rest();

  std::int64_t epoch_ns() const { return epoch_ns_; }
  std::uint64_t azimuths() const { return azimuths_; }  ///< kept so far
  /// Clear steps against the sense of most, and clear differences at one instant.
  std::uint64_t contradictions() const;
  double turns() const;     ///< from the first azimuth to the last
  double duration() const;  ///< [s] between these

 private:
  HeadPiece take_until(double time);

  std::int64_t epoch_ns_;
  double max_gap_;
  std::uint64_t azimuths_ = 0;
  std::uint64_t up_ = 0, down_ = 0;                 ///< clear steps of either sense
  std::uint64_t different_ = 0;                     ///< from another azimuth of the same instant
  std::optional<std::pair<double, double>> first_;  ///< time and angle
  std::vector<double> times_, angles_;              ///< for beams that were not handed out yet
  std::vector<Measurements> beams_;
};

}  // namespace crisp::devices
