// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>

namespace crisp::diagnose {

/// Lasting step of the encoder's count against the plate.
struct EncoderSlip {
  double at = 0;            ///< [s since epoch]
  double at_std_error = 0;  ///< [s]
  double by = 0;            ///< [rad] excess of later angles
  double by_std_error = 0;  ///< [rad]
  double p_value = 1;       ///< of the step (Wald test), corrected for the number of times tested
  /// Whether the encoder readings step within milliseconds, faster than a plate can turn. Otherwise the whole
  /// scanner may have turned on its base.
  bool is_in_readings = false;
};

/// Result of the search for encoder slips.
struct EncoderSlips {
  std::vector<EncoderSlip> slips;  ///< by time
  std::size_t shifts = 0;          ///< pairs of passes that were compared
  double tested = 0;               ///< [s] duration of the recording in which a slip is detectable
  double rms_before = 0;           ///< [rad] angle shifts that lags and rates do not explain
  double rms_after = 0;            ///< [rad] the same with the slips
  std::array<double, 2> ci95{};    ///< [rad] of rms_after − rms_before (block bootstrap)
};

/// Detects changepoints of the encoder's zero in the angle shifts between passes, by orthogonal matching
/// pursuit. Steps are added to an AngleShiftModel one by one where the score is largest, as long as they are
/// significant. The shifts are then measured again without the slips, which brings further slips within
/// range.
///
/// A slip at the instant of the only reversal cannot be distinguished from backlash, and is attributed to it.
/// In the first and last second few passes lie across a slip, so it is not detected there.
/// @param angle_step  [rad] of the encoder
EncoderSlips find_encoder_slips(const Measurements& beams, const PlateTrajectory& plate, double angle_step,
                                std::uint64_t seed);

/// The trajectory without the slips.
PlateTrajectory without_slips(const PlateTrajectory& plate, std::span<const EncoderSlip> slips);

}  // namespace crisp::diagnose
