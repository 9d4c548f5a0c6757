// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "pipeline/quality/surfels.hpp"

namespace crisp {

/// Least squares in m parameters θ, after the planes of all surfels have been projected out (variable
/// projection): near the present values the weighted sum of squared residuals is
///
///     chi2 + 2 vectorᵀ δθ + δθᵀ matrix δθ
struct NormalEquations {
  Eigen::MatrixXd matrix;  ///< m × m
  Eigen::VectorXd vector;  ///< m
  double chi2 = 0;         ///< now
  double freedom = 0;      ///< beams that count, less the three parameters of each surfel
  std::size_t beams = 0;   ///< that count, by however little
  double weight = 0;       ///< Σ of the beams' weights w = ψ(z)/z, of residuals z in units of their spread
  double influence = 0;    ///< Σ ψ(z)²
  double stiffness = 0;    ///< Σ ψ′(z)

  explicit NormalEquations(std::size_t parameters = 0);
  NormalEquations& operator+=(const NormalEquations& other);

  /// By what the inverse of `matrix` is to be multiplied to be the covariance of θ (Huber): it holds for
  /// whatever noise the residuals show, and for the beams that count less.
  double covariance_factor() const;

  /// The equations of the parameters `kept`, in this order, after those in `eliminated` have been projected
  /// out in turn, so that what they could explain no longer counts. The others are held as they are. What
  /// `eliminated` leaves undetermined is left alone.
  NormalEquations reduced(const std::vector<std::size_t>& kept,
                          const std::vector<std::size_t>& eliminated) const;
};

/// Told by whoever knows the sensor model: how parameters move points across a surfel.
///
/// @param surfel        whose normal counts
/// @param beams         some of its beams
/// @param range_change  [m] for each, by how much its range would have to grow to end on the plane. The
///                      derivatives are wanted there and not where the range's noise has put the point: noise
///                      in the regressors would look like parameters.
/// @param rows          for each beam, m numbers: normal · ∂x/∂θₖ; to be filled, zero at first
/// Called from several threads at once.
using DerivativeRows = std::function<void(const Surfel& surfel, std::span<const std::uint32_t> beams,
                                          std::span<const double> range_change, std::span<double> rows)>;

/// Adds up the equations of all surfels. Deterministic, on any number of threads.
NormalEquations normal_equations(const Surfels& surfels, const BeamsView& beams, std::size_t parameters,
                                 const DerivativeRows& derivatives, const SurfelSettings& settings);

/// How errors that beams share show in the equations: the sums of the beams' pulls on the parameters, after
/// the planes have been projected out, scatter by more than independent noise explains.
///
/// @param blocks  n numbers from 0: beams of one block may share an error, those of different blocks do not
/// @return        m × m: Σ over the blocks of their pull times its transpose, which has the expectation
///                covariance_factor() · matrix · (stiffness / weight)² if all errors are independent
/// Deterministic, on any number of threads.
Eigen::MatrixXd pull_of_blocks(const Surfels& surfels, const BeamsView& beams, std::size_t parameters,
                               const DerivativeRows& derivatives, const SurfelSettings& settings,
                               std::span<const std::uint32_t> blocks);

}  // namespace crisp
