// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "pipeline/model/range_variance.hpp"

namespace crisp {

/// By how much one laser's ranges are off: element i of all arrays is one of them.
struct RangeErrors {
  std::vector<float> value;          ///< [m] about the mean of its beam
  std::vector<float> range;          ///< [m] where the surface is
  std::vector<float> cosine;         ///< |cos β| there; empty where not known
  std::vector<float> remission;      ///< device's units; empty where not known
  std::vector<std::uint16_t> beam;   ///< index of its direction in the scan
  std::vector<std::uint32_t> block;  ///< pieces of the recording, to be held out by turns
  std::vector<std::uint32_t> place;  ///< on the surfaces; empty where not known

  std::size_t size() const { return value.size(); }
  void append(const RangeErrors& from, std::size_t i);
  /// Takes the mean of each beam off its values.
  void centre_beams();
  /// What is known of where range i was measured.
  EchoConditions echo(std::size_t i) const;
};

/// How ranges scatter: the normal law of the plain simulator, and what of `noise.*` is added to it.
///
/// The variance of a range is the sum of its parts; a share of the ranges scatters `tail_scale` times as
/// much; each beam's scatter about two values `separation` apart, the farther with a weight of the beam's
/// own.
struct NoiseLaw {
  ByPart size{0.012, 0, 0, 0};   ///< of each part of the variance: sigma, slope, spread, jitter
  double tail_share = 0;         ///< of 1
  double tail_scale = 5;         ///< see above
  double separation = 0;         ///< [m]
  std::vector<double> weight;    ///< by beam; empty without a separation
  std::vector<double> relative;  ///< by beam: its own σ over the usual one; empty where all are alike

  std::array<bool, kVarianceParts> parts{true};  ///< of which the variance is the sum
  bool has_tail = false;

  bool has(VariancePart part) const { return parts[static_cast<std::size_t>(part)]; }
  bool has_peaks() const { return !weight.empty(); }
  bool has_relative() const { return !relative.empty(); }
  bool is_normal() const;

  /// [m] of what does not depend on anything.
  double sigma() const { return size[static_cast<std::size_t>(VariancePart::kSigma)]; }

  /// [m] Standard deviation of one range, in neither a tail nor two peaks.
  double deviation(const EchoConditions& echo, std::uint16_t beam) const;

  /// ln of the density [1/m].
  double log_density(double value, const EchoConditions& echo, std::uint16_t beam) const;

  /// The value that a standard normal law has with the same probability below it.
  double normal_score(double value, const EchoConditions& echo, std::uint16_t beam) const;

  /// [m] An error as this law makes them.
  double drawn(std::mt19937_64& random, const EchoConditions& echo, std::uint16_t beam) const;

  /// [m²] with tails and both peaks.
  double variance(const EchoConditions& echo, std::uint16_t beam) const;
};

/// The likeliest law of those that have what `like` has, by expectation and maximisation.
///
/// @param settled  [nat] a round that brings less is the last. A few may still be
///                 missing then, on a slow way to the likeliest law.
NoiseLaw fitted(const NoiseLaw& like, const RangeErrors& errors, double settled = 0.02);

/// The ranges for which `keep(index)` holds, in their order.
RangeErrors select(const RangeErrors& errors, const std::function<bool(std::size_t)>& keep);

/// Some blocks of all, strewn, so that about `most` ranges are left.
RangeErrors thinned(const RangeErrors& errors, std::size_t most);

/// How many beams there are: one more than the greatest index.
std::size_t beams_of(const RangeErrors& errors);

}  // namespace crisp
