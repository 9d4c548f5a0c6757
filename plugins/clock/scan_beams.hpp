// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include <crisp/measurements.hpp>
#include <crisp/rig.hpp>
#include <crisp/scan.hpp>

namespace crisp::clock {

/// A scan of which it is known when the mirror swept it.
struct TimedScan {
  std::shared_ptr<const Scan> scan;
  double begin = 0;  ///< [s since the epoch] hub time of its stamp: of the first possible beam, at −45°, or
                     ///< of beam 0, see BeamTiming
  double period = 0;  ///< [s] of hub time: a turn of the mirror

  /// [s since the epoch] hub time at which beam k was fired.
  double beam_time(std::size_t k) const;
  double beam_interval() const;  ///< [s] from beam to beam
};

/// The measurements of a scan: one for each echo of each beam that came back, in the order of firing; those
/// of one beam have its time.
///
/// @param timed   with at least one echo
/// @param laser   gives the offset of the reported angles from θ
/// @param epoch_ns [ns since the Unix epoch]
/// @param out     holds them afterwards, and nothing else
void fill_measurements(const TimedScan& timed, const RigLaser& laser, std::int64_t epoch_ns,
                       Measurements& out);

}  // namespace crisp::clock
