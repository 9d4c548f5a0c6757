// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "plugins/scans/scan_series.hpp"

namespace crisp {

/// Whether the scans of a laser at rest are all alike, or take turns.
struct Alternation {
  std::vector<double> difference;  ///< [m] element l − 1: mean size of the difference between scans l apart
  std::size_t period = 1;          ///< scans after which they are alike again; 1: always
  double p_value = 1;        ///< that scans in random order differ as much more at one lag than at another
  double beyond_chance = 0;  ///< [m] by how much more they differ than scans in random order do
};

/// Scans at rest that are looked at; more tell nothing more.
inline constexpr std::size_t kEnoughAtRest = 400;

/// Which number of scans apart makes scans most alike (LagContrast).
/// @param scans  of a laser that stands still in a scene that does
Alternation find_alternation(const std::vector<SeriesScan>& scans, std::uint64_t seed);

/// How one kind of scan departs from the kind that it is compared with, at rest.
struct KindDeparture {
  std::size_t kind = 0;  ///< count modulo the period
  std::size_t scans = 0;
  std::size_t beams = 0;  ///< that the comparison rests on
  double shift = 0;       ///< [beams] its beams point so much further than is declared
  double shift_error = 0;
  double offset = 0;  ///< [m] of its ranges, once the shift is taken out
  double offset_error = 0;
  double log10_odds = 0;  ///< of the shift against the next likely of: none, an offset, a scale of the ranges
  const char* next_likely = "";
  Gain gain;                             ///< profile at rest, on scans that the shift was not found in
  std::vector<double> error_over_shift;  ///< [m] RMS, over shift_grid()
  double put_in = 0;  ///< [beams] a shift put by hand into half of the scans of one kind …
  double answer = 0;  ///< … and what the same comparison made of it
};

/// [beams] the shifts that are tried.
const std::vector<double>& shift_grid();

/// Compares each kind of scan with the kind that has most beams. Found in the first half of the scans, judged
/// by the second. Which beams count is decided in the kind that is compared with: neighbours must be near.
std::vector<KindDeparture> compare_kinds(const std::vector<SeriesScan>& scans, std::size_t period,
                                         std::uint64_t seed);

/// The kind that others are compared with.
std::size_t reference_kind(const std::vector<SeriesScan>& scans, std::size_t period);

}  // namespace crisp
