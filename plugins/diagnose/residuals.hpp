// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/quality/surfels.hpp"
#include "plugins/diagnose/evidence.hpp"

namespace crisp {

/// By how much one recording's ranges miss the surfaces, and how much each counts.
struct Weighed {
  std::vector<double> value;   ///< [m] along the beam
  std::vector<double> weight;  ///< 0 to 1: Tukey's
};

/// The beams that count, surface by surface.
struct Residuals {
  std::vector<std::uint32_t> beam;
  Weighed measured;
  std::vector<double> cosine;            ///< of the incidence, positive
  std::vector<double> told;              ///< [m] noise that the surfels were told
  std::vector<double> end;               ///< [m] along the beam: from there on Tukey's weight is 0
  std::vector<Eigen::MatrixX3d> planes;  ///< of each surface: what its plane can take, orthonormal
  std::vector<std::size_t> first;        ///< beam of each surface; one more than there are

  std::size_t size() const { return beam.size(); }
};

Residuals residuals_in(const Evidence& evidence, const SurfelSettings& settings);

/// Standard deviation of each laser's ranges, in units of what the surfels were told, from the median
/// difference of neighbours: beams of one scan on one surface. Lasers that disagree, and whatever else
/// changes slowly, are not in it. Where there are hardly any neighbours, from all residuals.
std::vector<double> noise_of(const Residuals& residuals, const Measurements& beams);

/// [m²] Mean product of the residuals of neighbours: what all of one scan that meet one surface are off by
/// together. Noise of each range by itself, of whatever law, is not in it. 0 without any.
///
/// @param values  of `residuals`: those measured, or others in their place
double shared_square(const Residuals& residuals, const Weighed& values, const Measurements& beams);

/// What noise leaves of a simulated recording, once planes have been fitted to it: normal noise, weighed as
/// measured residuals are.
///
/// @param noise  of each residual, in units of what the surfels were told
Weighed simulated(const Residuals& residuals, const std::vector<double>& noise, std::uint64_t seed);

}  // namespace crisp
