// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crisp {

/// By how much one laser's ranges are off: element i of all arrays is one of them.
struct RangeErrors {
  std::vector<float> value;          ///< [m] about the mean of its beam
  std::vector<float> range;          ///< [m] where the surface is
  std::vector<std::uint16_t> beam;   ///< index of its direction in the scan
  std::vector<std::uint32_t> block;  ///< pieces of the recording, to be held out by turns

  std::size_t size() const { return value.size(); }
};

/// How ranges scatter: the normal law of the plain simulator, and what of `noise.*` is added to it.
///
/// `σ(r) = √(sigma² + (slope r)²)`; a share of the ranges scatters `tail_scale` times as much; each beam's
/// scatter about two values `separation` apart, the farther with a weight of the beam's own.
struct NoiseLaw {
  double sigma = 0.012;        ///< [m]
  double slope = 0;            ///< [m] a metre
  double tail_share = 0;       ///< of 1
  double tail_scale = 5;       ///< see above
  double separation = 0;       ///< [m]
  std::vector<double> weight;  ///< by beam; empty without a separation
  std::vector<double> spread;  ///< by beam: of its own σ over the usual one; empty where all are alike

  bool has_slope = false;
  bool has_tail = false;
  bool has_peaks() const { return !weight.empty(); }
  bool has_spread() const { return !spread.empty(); }
  bool is_normal() const { return !has_slope && !has_tail && !has_peaks() && !has_spread(); }

  /// ln of the density [1/m].
  double log_density(double value, double range, std::uint16_t beam) const;

  /// [m²] of all parts together.
  double variance(double range, std::uint16_t beam) const;
};

/// The likeliest law of those that have what `like` has, by expectation and maximisation.
NoiseLaw fitted(const NoiseLaw& like, const RangeErrors& errors);

/// How many beams there are: one more than the greatest index.
std::size_t beams_of(const RangeErrors& errors);

}  // namespace crisp
