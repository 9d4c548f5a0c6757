// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/data/measurements.hpp"
#include "pipeline/data/plate_trajectory.hpp"

namespace crisp {

/// A step of the encoder's count against the plate, which stays.
struct EncoderSlip {
  double at = 0;            ///< [s since epoch]
  double at_std_error = 0;  ///< [s]
  double by = 0;            ///< [rad] by which later angles are too large
  double by_std_error = 0;  ///< [rad]
  double p_value = 1;       ///< of the step (Wald test), corrected for the number of times that were tried
  /// Whether the encoder readings step within milliseconds, as no plate can turn; otherwise the whole scanner
  /// may have turned on its base.
  bool is_in_readings = false;
};

struct EncoderSlips {
  std::vector<EncoderSlip> slips;  ///< by time
  std::size_t shifts = 0;          ///< pairs of passes that were compared
  double tested = 0;               ///< [s] of the recording, in which enough of them lie across a slip
  double rms_before = 0;           ///< [rad] of the angle shifts that lags and speeds do not explain
  double rms_after = 0;            ///< [rad] with the slips
  std::array<double, 2> ci95{};    ///< [rad] of rms_after − rms_before (block bootstrap)
};

/// Finds changepoints of the encoder's zero in the angle shifts between passes, by orthogonal matching
/// pursuit: steps are added to an AngleShiftModel one by one where the score is largest, as long as they are
/// significant. The shifts are then measured again without the slips, which brings others within reach.
///
/// A slip at the instant of the only reversal cannot be distinguished from backlash, and is left to it. In
/// the first and last second few passes lie across a slip; it is not found there.
///
/// @param angle_step  [rad] of the encoder
EncoderSlips find_encoder_slips(const Measurements& beams, const PlateTrajectory& plate, double angle_step,
                                std::uint64_t seed);

/// The trajectory without the slips.
PlateTrajectory without_slips(const PlateTrajectory& plate, std::span<const EncoderSlip> slips);

}  // namespace crisp
