// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/quality/surfels.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"

namespace crisp::diagnose {

/// Residuals of one recording's ranges from the surfaces, with robust weights.
struct WeightedResiduals {
  std::vector<double> value;   ///< [m] along the beam
  std::vector<double> weight;  ///< Tukey's biweight, 0 to 1
};

/// Residuals of the beams of positive weight, sorted by surface.
struct Residuals {
  std::vector<std::uint32_t> beam;
  WeightedResiduals measured;
  std::vector<double> cosine;            ///< of the incidence angle, positive
  std::vector<double> reported;          ///< [m] noise assumed by the surfels
  std::vector<double> end;               ///< [m] along the beam: where Tukey's weight reaches 0
  std::vector<Eigen::MatrixX3d> planes;  ///< per surface: orthonormal basis of the plane's column space
  std::vector<std::size_t> first;        ///< first beam of each surface; one more than there are

  std::size_t size() const { return beam.size(); }
};

/// Residuals at the model of `observations`.
Residuals residuals_in(const SurfaceObservations& observations, const quality::SurfelSettings& settings);

/// Range noise of each laser relative to the noise assumed by the surfels, from the median absolute
/// difference of consecutive residuals of one scan on one surface. Differences between lasers and slow
/// changes cancel. With too few such pairs, it is the estimate from all residuals.
std::vector<double> noise_of(const Residuals& residuals, const Measurements& beams);

/// [m²] Mean product of consecutive residuals of one scan on one surface: the common-mode error of such
/// beams. Independent noise of any distribution has expectation 0. Returns 0 without pairs.
///
/// @param values  measured residuals, or simulated ones in their place
double shared_square(const Residuals& residuals, const WeightedResiduals& values, const Measurements& beams);

/// Simulates residuals of independent normal noise after the fit of the surfaces' planes, weighted like the
/// measured ones.
///
/// @param noise  of each residual, relative to the noise assumed by the surfels
WeightedResiduals simulated(const Residuals& residuals, const std::vector<double>& noise, std::uint64_t seed);

}  // namespace crisp::diagnose
