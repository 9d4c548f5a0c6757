// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <crisp/findings.hpp>
#include <crisp/plate_trajectory.hpp>

#include "plugins/diagnose/scans/scan_series.hpp"

namespace crisp::diagnose {

/// One scan of a pass at its actuator angle.
struct PassScan {
  double angle = 0;  ///< [rad]
  const std::vector<float>* ranges = nullptr;
};

/// A pass of the actuator in one direction.
struct Pass {
  bool up = true;               ///< whether angles increase
  std::vector<PassScan> scans;  ///< sorted by angle
};

/// Splits a series where the actuator reverses. Passes shorter than `shortest` [rad] are left out.
std::vector<Pass> find_passes(const ScanSeries& series, const PlateTrajectory& actuator, double shortest);

/// Sums over a block of neighbouring angles and beams that two passes compare.
struct PassBlock {
  struct Bin {
    double n = 0;
    double by = 0;       ///< [rad] Σ of the angle differences
    double error = 0;    ///< [m] Σ of the range differences
    double squares = 0;  ///< [m²] Σ of their squares
  };
  std::size_t angle_part = 0;  ///< from 0 to kAngleParts − 1
  std::size_t beam_part = 0;   ///< from 0 to kBeamParts − 1
  std::vector<Bin> bins;       ///< by angle difference, in steps from −kReach to kReach
};

inline constexpr std::size_t kAngleParts = 16;
inline constexpr std::size_t kBeamParts = 8;
inline constexpr std::size_t kPassBlocks = kAngleParts * kBeamParts;
inline constexpr int kReach = 9;  ///< [steps] largest angle difference of compared scans

/// Comparison of two passes in opposite directions.
struct PassComparison {
  double step = 0;  ///< [rad] from scan to scan
  std::vector<PassBlock> blocks;
  std::size_t beams = 0;  ///< number of compared beams of the downward pass
};

/// Compares each beam of the downward pass with those of the upward pass at angles up to kReach steps away. A
/// beam counts if its range and all of these lie within 0.15 m (no edge). The selection uses the reported
/// angle.
///
/// @param injected  [rad] injected into the angles of the downward pass
PassComparison compare_passes(const Pass& up, const Pass& down, double injected = 0);

/// Estimates the shift [rad] between the passes: down(φ) = up(φ + shift). It minimizes the variance of the
/// range differences over the shift. Noise adds the same variance to each bin, so the estimate has no
/// attenuation bias, unlike a regression on measured slopes. A locally weighted cubic is fitted through the
/// bins around the minimum: curved surfaces make the minimum asymmetric, which would bias a parabola. Each
/// bin's mean difference, a range offset between the passes, is subtracted.
///
/// @return NaN if the minimum lies at the border of the bins
double shift_between(const PassComparison& comparison, std::span<const std::size_t> blocks);

/// [m²] Variance of the differences at a shift [rad], interpolated linearly between bins.
double variance_at(const PassComparison& comparison, std::span<const std::size_t> blocks, double shift);

/// Estimated shift between two passes, with its tests.
struct PassOffset {
  double shift = 0;      ///< [rad]
  double std_error = 0;  ///< bootstrap over blocks
  double offset = 0;     ///< [m] ranges of the downward pass less those of the upward pass, at the shift
  std::vector<std::pair<double, double>>
      by_angle;  ///< [rad] shift and standard error in each quarter of the angles
  std::vector<std::pair<double, double>> by_beam;  ///< the same in each quarter of the beams
  std::pair<double, double> fitted{};              ///< the same in every other sixteenth of the angles …
  std::pair<double, double> held_out{};            ///< … and in the others
  double constant_p = 1;                           ///< homogeneity test of the quarters
  Gain gain;  ///< held-out beams: difference between the passes without and with the shift
  std::vector<std::pair<double, double>>
      recovered_shifts;       ///< [rad] injected shifts and the change of the estimate
  double recovery_slope = 0;  ///< regression slope of the recovered on the injected shifts
};

/// Estimates the shift between two passes and tests it.
PassOffset find_shift(const Pass& up, const Pass& down, std::uint64_t seed);

}  // namespace crisp::diagnose
