// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "pipeline/model/range_variance.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::diagnose {

/// Range errors of one laser with their covariates, as arrays over its ranges.
struct RangeErrors {
  std::vector<float> value;          ///< [m] about the mean of its beam
  std::vector<float> range;          ///< [m] to the surface
  std::vector<float> cosine;         ///< |cos β| of the incidence; empty if unknown
  std::vector<float> remission;      ///< device's units; empty if unknown
  std::vector<std::uint16_t> beam;   ///< index of its direction in the scan
  std::vector<std::uint32_t> block;  ///< block of the recording, for cross-validation
  std::vector<std::uint32_t> place;  ///< cell on the surfaces; empty if unknown

  std::size_t size() const { return value.size(); }
  void append(const RangeErrors& from, std::size_t i);
  /// Subtracts each beam's mean from its values.
  void centre_beams();
  /// Covariates of range i.
  model::EchoConditions echo(std::size_t i) const;
};

/// Noise model of ranges: the plain simulator's normal distribution, extended by components of `noise.*`.
///
/// The variance is the sum of its parts. A share of the ranges has `tail_scale` times the standard deviation.
/// With two peaks, each beam's distribution is a mixture about two values `separation` apart, with a weight
/// of the farther peak per beam.
struct NoiseModel {
  model::ByPart size{0.012, 0, 0, 0};  ///< sizes of the variance's parts: sigma, slope, spread, jitter
  double tail_share = 0;               ///< share of ranges in the tail
  double tail_scale = 5;               ///< relative standard deviation of the tail
  double separation = 0;               ///< [m] between the two peaks
  std::vector<double> weight;          ///< of the farther peak, by beam; empty without a separation
  std::vector<double> relative;        ///< relative standard deviation by beam; empty if all are equal

  std::array<bool, model::kVarianceParts> parts{true};  ///< parts of the variance that the model has
  bool has_tail = false;

  bool has(model::VariancePart part) const { return parts[static_cast<std::size_t>(part)]; }
  bool has_peaks() const { return !weight.empty(); }
  bool has_relative() const { return !relative.empty(); }
  bool is_normal() const;

  /// [m] Constant part of the standard deviation.
  double sigma() const { return size[static_cast<std::size_t>(model::VariancePart::kSigma)]; }

  /// [m] Standard deviation of one range, without tail and second peak.
  double deviation(const model::EchoConditions& echo, std::uint16_t beam) const;

  /// ln of the density [1/m].
  double log_density(double value, const model::EchoConditions& echo, std::uint16_t beam) const;

  /// Quantile of the standard normal distribution at the value's cumulative probability.
  double normal_score(double value, const model::EchoConditions& echo, std::uint16_t beam) const;

  /// [m] Draws a random error.
  double drawn(statistics::RandomStream& random, const model::EchoConditions& echo, std::uint16_t beam) const;

  /// [m²] Variance including the tail and both peaks.
  double variance(const model::EchoConditions& echo, std::uint16_t beam) const;
};

/// Fits a noise model of the structure of `like` by maximum likelihood (EM algorithm).
///
/// @param settled  [nat] the iteration ends at a smaller improvement. Slow convergence may leave a few nat.
NoiseModel fitted(const NoiseModel& like, const RangeErrors& errors, double settled = 0.02);

/// The ranges for which `keep(index)` holds, in order.
RangeErrors select(const RangeErrors& errors, const std::function<bool(std::size_t)>& keep);

/// Subset of pseudo-random blocks with about `most` ranges.
RangeErrors thinned(const RangeErrors& errors, std::size_t most);

/// Number of beams: the greatest index plus one.
std::size_t beams_of(const RangeErrors& errors);

}  // namespace crisp::diagnose
