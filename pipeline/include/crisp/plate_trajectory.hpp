// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace crisp {

/// [s] Half width of the window over which encoder readings are smoothed, unless a user asks for another one.
/// A plate has mass: its rate changes smoothly.
inline constexpr double kEncoderSmoothing = 0.2;

/// State of the plate at an instant.
struct PlateState {
  double angle = 0;         ///< [rad] φ, unwrapped
  double rate = 0;          ///< [rad/s] dφ/dt
  double acceleration = 0;  ///< [rad/s²]
  /// In which direction it has turned last: −1 clockwise, 1 counter-clockwise, seen from +z. Kept at
  /// standstill, and between both for 0.01 rad after a reversal; 0 where it never turned.
  double direction = 0;
  double direction_rate = 0;  ///< [1/s] d direction/dt
};

/// φ(t) between two neighbouring readings of the encoder: a cubic of u = (t − begin) / width.
struct PlateArc {
  double begin = 0;                      ///< [s since epoch] of the first reading
  double end = 0;                        ///< [s since epoch] of the second
  double width = 0;                      ///< [s] end − begin
  std::array<double, 4> coefficients{};  ///< [rad] of 1, u, u², u³
  std::array<double, 2> directions{};    ///< at the first reading and at the second, linear between them

  /// The plate at time t [s since epoch], from `begin` to `end`.
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

  /// The arc that at() interpolates on; valid for all times from `begin` to `end`, ends included.
  std::optional<PlateArc> arc(double t) const;

  /// The reading with which the arc of t begins, or nothing where the readings do not cover t.
  std::optional<std::size_t> interval(double t) const;

  /// The same with other angles [rad], one a reading.
  PlateTrajectory with_angles(std::vector<double> angles) const;

  std::int64_t epoch_ns() const { return epoch_ns_; }  ///< [ns since the Unix epoch] zero of the times
  bool empty() const { return times_.empty(); }        ///< whether there is no reading
  std::size_t size() const { return times_.size(); }   ///< number of readings
  double begin() const { return times_.front(); }      ///< [s since epoch]; not of an empty trajectory
  double end() const { return times_.back(); }         ///< [s since epoch]; not of an empty trajectory
  double max_gap() const { return max_gap_; }          ///< [s] longest silence that is interpolated across
  std::span<const double> times() const { return times_; }    ///< [s since epoch] of the readings
  std::span<const double> angles() const { return angles_; }  ///< [rad] φ of the readings
  std::span<const double> rates() const { return rates_; }    ///< [rad/s] dφ/dt at each reading
  std::span<const double> new_zeros() const {
    return new_zeros_;
  }  ///< [s since epoch] when the encoder began to count anew

 private:
  std::size_t part_of(double t) const;

  std::int64_t epoch_ns_ = 0;
  std::vector<double> times_;
  std::vector<double> angles_;
  std::vector<double> rates_;
  std::vector<double> directions_;
  std::vector<double> new_zeros_;
  double max_gap_ = 0;
  // Number of parts of equal length per second: as many parts as intervals. For about even readings, one to a
  // few of them begin in each, so that a time's interval is found at once.
  double parts_a_second_ = 0;
  std::vector<std::uint32_t>
      first_;  // part → the last interval that begins in a part before it, or the first
};

// Inline, since it is called for each of many beams.
inline std::size_t PlateTrajectory::part_of(double t) const {
  const std::size_t last = first_.size() - 2;
  const double parts = (t - times_.front()) * parts_a_second_;
  return parts < static_cast<double>(last) ? static_cast<std::size_t>(parts) : last;
}

inline std::optional<std::size_t> PlateTrajectory::interval(double t) const {
  if (first_.empty() || !(t >= times_.front() && t <= times_.back())) return std::nullopt;
  const double* times = times_.data();
  const std::size_t part = part_of(t);
  std::size_t found = first_[part];
  const std::size_t last = first_[part + 1];
  // Mostly one step or two, unpredictably: without a branch.
  for (int step = 0; step < 2; ++step) {
    found += static_cast<std::size_t>(static_cast<unsigned>(found < last) &
                                      static_cast<unsigned>(t >= times[found + 1]));
  }
  if (found < last && t >= times[found + 1]) {
    found = static_cast<std::size_t>(std::upper_bound(times + found + 1, times + last + 1, t) - times) - 1;
  }
  if (times[found + 1] - times[found] > max_gap_) return std::nullopt;
  return found;
}

}  // namespace crisp
