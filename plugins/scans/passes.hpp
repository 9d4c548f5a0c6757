// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/data/plate_trajectory.hpp"
#include "plugins/scans/scan_series.hpp"

namespace crisp {

/// One scan of a pass, at the actuator's angle.
struct PassScan {
  double angle = 0;  ///< [rad]
  const std::vector<float>* ranges = nullptr;
};

/// The actuator on its way in one direction.
struct Pass {
  bool up = true;               ///< whether angles grow
  std::vector<PassScan> scans;  ///< in the order of angles
};

/// Cuts a series where the actuator turns back. Passes shorter than `shortest` [rad] are left out.
std::vector<Pass> find_passes(const ScanSeries& series, const PlateTrajectory& actuator, double shortest);

/// A part of what two passes saw: beams of neighbouring angles and numbers.
struct PassBlock {
  struct Bin {
    double n = 0;
    double by = 0;       ///< [rad] Σ of the differences in angle
    double error = 0;    ///< [m] Σ
    double squares = 0;  ///< [m²] Σ
  };
  std::size_t angle_part = 0;  ///< from 0 to kAngleParts − 1
  std::size_t beam_part = 0;   ///< from 0 to kBeamParts − 1
  std::vector<Bin> bins;       ///< by difference in angle, in steps from −kReach to kReach
};

inline constexpr std::size_t kAngleParts = 16;
inline constexpr std::size_t kBeamParts = 8;
inline constexpr std::size_t kPassBlocks = kAngleParts * kBeamParts;
inline constexpr int kReach = 9;  ///< [steps] how far apart scans of the two passes are compared

/// Two passes in opposite directions, side by side.
struct PassComparison {
  double step = 0;  ///< [rad] from scan to scan
  std::vector<PassBlock> blocks;
  std::size_t beams = 0;  ///< of the pass down that were compared
};

/// Compares each beam of the pass down with those of the pass up at angles up to kReach steps off. A beam
/// counts if its range and all of these lie within 0.15 m: no edge passes by. That is decided around the
/// angle as it was read.
///
/// @param put_in  [rad] that is added to the angles of the pass down by hand
PassComparison compare_passes(const Pass& up, const Pass& down, double put_in = 0);

/// The shift [rad] of the pass down at which both passes agree best: down(φ) = up(φ + shift). It is where the
/// variance of the differences, as a function of the shift, has its least value: noise adds the same to each
/// bin and moves nothing, where a regression on measured slopes comes out short by their noise. A cubic is
/// laid through the bins around the answer, the nearer the more they count: surfaces that bend make the
/// valley lopsided, which a parabola would take for a shift. A range offset between the passes is taken out
/// of each bin.
/// @return NaN where the least lies at the rim
double shift_between(const PassComparison& comparison, std::span<const std::size_t> blocks);

/// [m²] variance of the differences at a shift [rad], straight between bins.
double variance_at(const PassComparison& comparison, std::span<const std::size_t> blocks, double shift);

/// What the passes say.
struct PassShift {
  double shift = 0;      ///< [rad]
  double std_error = 0;  ///< by a bootstrap over blocks
  double offset = 0;     ///< [m] ranges of the pass down less those of the pass up, at the shift
  std::vector<std::pair<double, double>>
      by_angle;  ///< [rad] shift and its error, in each quarter of the angles
  std::vector<std::pair<double, double>> by_beam;  ///< the same, in each quarter of the beams
  std::pair<double, double> fitted{};              ///< the same, in every other sixteenth of the angles …
  std::pair<double, double> held_out{};            ///< … and in the rest
  double constant_p = 1;                           ///< that these differ by their errors alone
  Gain gain;  ///< difference between the passes, on beams that the shift was not found in
  std::vector<std::pair<double, double>> answers;  ///< [rad] shifts put in by hand, and what they changed
  double answer_ratio = 0;                         ///< slope of the one over the other
};

PassShift find_shift(const Pass& up, const Pass& down, std::uint64_t seed);

}  // namespace crisp
