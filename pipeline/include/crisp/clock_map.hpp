// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace crisp {

/// One straight piece of a clock map, valid from `device_begin` to the next piece's.
struct ClockPiece {
  double device_begin = 0;    ///< [s] unwrapped device time at which the piece begins
  double hub_begin = 0;       ///< [s since the run's epoch] hub time there
  double rate = 1;            ///< hub seconds per device second; skew = rate − 1
  double rate_std_error = 0;  ///< standard error of the rate
};

/// The pieces of a clock map, ascending in device_begin. There is always one: a clock of which nothing is
/// known has no map.
class ClockPieces {
 public:
  /// A map of one piece.
  explicit ClockPieces(const ClockPiece& first) : pieces_{first} {}
  /// @throws Error unless they ascend
  ClockPieces(const ClockPiece& first, const std::vector<ClockPiece>& others);

  /// @throws Error unless it begins after the last one
  void append(const ClockPiece& piece);
  /// Puts a piece in the place of the last one. @throws Error unless it begins after the one before that
  void replace_last(const ClockPiece& piece);
  /// Removes the last piece. @return whether there was another one before it; the first stays
  bool drop_last();

  const ClockPiece& front() const { return pieces_.front(); }               ///< the first piece
  const ClockPiece& back() const { return pieces_.back(); }                 ///< the last piece
  const ClockPiece& operator[](std::size_t i) const { return pieces_[i]; }  ///< piece i, from 0
  std::size_t size() const { return pieces_.size(); }                       ///< number of pieces, ≥ 1
  auto begin() const { return pieces_.begin(); }  ///< of the pieces, in the order of device time
  auto end() const { return pieces_.end(); }      ///< of the pieces

 private:
  std::vector<ClockPiece> pieces_;
};

/// device time → hub time of one device: continuous and piecewise linear between resets of the device.
struct ClockMap {
  std::string device;          ///< the rig's name of it, "laser1" or "plate"
  ClockPieces pieces;          ///< at least one
  double device_end = 0;       ///< [s] unwrapped device time of the last stamp
  double skew_std_error = 0;   ///< standard error of the mean skew, as a ratio
  double std_error = 0;        ///< [s] standard error of the hub times, in the mean over the recording
  double residual_median = 0;  ///< [s] median delay of the stamps above the line
  double residual_95 = 0;      ///< [s] 95 % quantile of it
  std::size_t stamps = 0;      ///< pairs (device time, receipt time) that the map is fitted to

  /// @param device_time [s] unwrapped device time; outside the pieces the first or last is extended
  /// @return [s since the run's epoch]
  double to_hub(double device_time) const;
  /// Mean skew over all pieces, weighted by their duration up to device_end, in parts per million.
  double skew_ppm() const;
};

}  // namespace crisp
