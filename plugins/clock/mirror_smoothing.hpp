// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crisp::clock {

/// A laser's stamp of its mirror's index pulse.
struct MirrorStamp {
  std::int64_t turn = 0;  ///< which turn it was: the scan counter, unwrapped
  double time = 0;        ///< [s] device time, with its jitter
};

/// When the mirror passed its index, and how fast it then turned.
struct MirrorTurn {
  double time = 0;    ///< [s] device time
  double period = 0;  ///< [s] of device time a turn
};

/// Settings for smoothing the turns.
struct MirrorSmoothing {
  std::size_t half_width = 0;  ///< number of stamps used on either side; 0: by cross-validation
  double nominal_period = 0;   ///< [s] for a stamp that stands alone
};

/// The motion of a mirror from its stamps: a real mirror is off its nominal rate by up to 0.6 %, wanders by
/// 0.2 % within seconds, and its stamps scatter by microseconds, some by more (data: LMS111, TiM781S).
///
/// A parabola over the turn number is fitted to each stamp and its neighbours, within runs of stamps without
/// large gaps; stamps that stand out by more than three times the scatter count no more than that (Huber).
/// The half width, if not given, is the one with the best predictions of stamps from their neighbours
/// (leave-one-out cross-validation, median of the absolute errors): 2 to 10.
///
/// @param stamps ascending in turn and time
/// @return one turn a stamp
std::vector<MirrorTurn> smooth_mirror(std::span<const MirrorStamp> stamps, const MirrorSmoothing& smoothing);

}  // namespace crisp::clock
