// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace crisp {

/// Where the plate is at an instant.
struct PlateState {
  double angle = 0;         ///< [rad] φ, unwrapped
  double rate = 0;          ///< [rad/s] dφ/dt
  double acceleration = 0;  ///< [rad/s²]
};

/// φ(t) between two neighbouring readings of the encoder: a cubic of u = (t − begin) / width.
struct PlateArc {
  double begin = 0;                      ///< [s since epoch] of the first reading
  double end = 0;                        ///< [s since epoch] of the second
  double width = 0;                      ///< [s] end − begin
  std::array<double, 4> coefficients{};  ///< [rad] of 1, u, u², u³

  PlateState at(double t) const;
};

/// φ(t): the plate's angle, continuous, by cubic Hermite interpolation between the encoder's readings
/// (slopes: the three-point differences of Catmull and Rom for uneven spacing). Never extrapolates, and
/// never interpolates across a silence of the encoder longer than `max_gap`.
class PlateTrajectory {
 public:
  PlateTrajectory() = default;

  /// @param epoch_ns [ns since the Unix epoch] zero of the times
  /// @param times    [s since epoch] strictly ascending
  /// @param angles   [rad] unwrapped, one a time
  /// @param max_gap  [s] longest silence to interpolate across
  /// @param new_zeros [s since epoch] when the encoder began to count anew: angles from then on have no zero
  ///                 in common with those before
  /// @throws Error   if the lengths differ or the times do not ascend
  PlateTrajectory(std::int64_t epoch_ns, std::vector<double> times, std::vector<double> angles,
                  double max_gap, std::vector<double> new_zeros = {});

  /// The plate at time t [s since epoch], or nothing where the readings do not cover t.
  std::optional<PlateState> at(double t) const;

  /// A reader for times that mostly ascend: remembers the interval, so that a step costs O(1).
  class Cursor {
   public:
    explicit Cursor(const PlateTrajectory& trajectory) : trajectory_(&trajectory) {}
    std::optional<PlateState> at(double t);
    /// What at() takes its answer from; it holds for all times from `begin` to `end`, ends included.
    std::optional<PlateArc> arc(double t);

   private:
    const PlateTrajectory* trajectory_;
    std::size_t interval_ = 0;
  };

  std::int64_t epoch_ns() const { return epoch_ns_; }
  bool empty() const { return times_.empty(); }
  std::size_t size() const { return times_.size(); }
  double begin() const { return times_.front(); }  ///< [s since epoch]; not of an empty trajectory
  double end() const { return times_.back(); }     ///< [s since epoch]; not of an empty trajectory
  double max_gap() const { return max_gap_; }
  std::span<const double> times() const { return times_; }
  std::span<const double> angles() const { return angles_; }
  std::span<const double> new_zeros() const { return new_zeros_; }

 private:
  std::optional<PlateArc> arc(std::size_t interval) const;

  std::int64_t epoch_ns_ = 0;
  std::vector<double> times_;
  std::vector<double> angles_;
  std::vector<double> rates_;
  std::vector<double> new_zeros_;
  double max_gap_ = 0;
};

}  // namespace crisp
