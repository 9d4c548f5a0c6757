// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <crisp/findings.hpp>

#include "plugins/diagnose/scans/scan_series.hpp"

namespace crisp::diagnose {

/// Period of the scan classes of a stationary laser.
struct ScanInterleave {
  std::vector<double> difference;  ///< [m] element l − 1: mean absolute difference of scans at lag l
  std::size_t period = 1;          ///< lag at which scans are alike; 1: all scans are
  double p_value = 1;              ///< permutation test of the contrast between lags
  double beyond_chance = 0;        ///< [m] contrast beyond that of scans in random order
};

/// Maximum number of stationary scans evaluated; more do not improve the test.
inline constexpr std::size_t kEnoughStationary = 400;

/// Finds the lag at which scans are most alike (LagContrast).
///
/// @param scans  of a stationary laser in a static scene
ScanInterleave find_interleave(const std::vector<SeriesScan>& scans, std::uint64_t seed);

/// Offset of one scan class from the reference class, for a stationary laser.
struct ClassOffset {
  std::size_t kind = 0;  ///< scan class: count modulo the period
  std::size_t scans = 0;
  std::size_t beams = 0;  ///< number of beams compared
  double shift = 0;       ///< [beams] excess of the beams' direction over the declared one
  double shift_error = 0;
  double offset = 0;  ///< [m] of the ranges, after the shift is removed
  double offset_error = 0;
  double log10_bayes_factor =
      0;  ///< of the shift against the best of: nothing, a range offset, a range scale
  const char* next_likely = "";
  Gain gain;  ///< held-out scans: difference of the profiles without and with the shift
  std::vector<double> error_over_shift;  ///< [m] RMS, over shift_grid()
  double injected = 0;                   ///< [beams] shift injected into half of the reference scans …
  double recovered = 0;                  ///< … and its estimate by the same comparison
};

/// [beams] Grid of the tested shifts.
const std::vector<double>& shift_grid();

/// Compares each scan class with the reference class. The first half of the scans gives the estimate, the
/// second half validates it. Beams count where neighbouring ranges of the reference class are close.
std::vector<ClassOffset> compare_classes(const std::vector<SeriesScan>& scans, std::size_t period,
                                         std::uint64_t seed);

/// The reference class: that with the most beams.
std::size_t reference_class(const std::vector<SeriesScan>& scans, std::size_t period);

}  // namespace crisp::diagnose
