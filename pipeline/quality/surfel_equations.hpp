// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "pipeline/quality/surfels.hpp"

namespace crisp::quality {

/// A partition of n beams into blocks: the block of each, numbered from 0. Beams of one block may share an
/// error, those of different blocks do not.
using Division = std::vector<std::uint32_t>;

/// Least squares in m parameters θ, after the planes of all surfels have been projected out (variable
/// projection): near the present values the weighted sum of squared residuals is
///
///     chi2 + 2 vectorᵀ δθ + δθᵀ matrix δθ
struct NormalEquations {
  Eigen::MatrixXd matrix;         ///< m × m
  Eigen::VectorXd vector;         ///< m
  double chi2 = 0;                ///< now
  double degrees_of_freedom = 0;  ///< beams that count, less the three parameters of each surfel
  std::size_t beams = 0;          ///< that count, by however little
  double weight = 0;     ///< Σ of the beams' weights w = ψ(z)/z, of residuals z in units of their spread
  double influence = 0;  ///< Σ ψ(z)²
  double stiffness = 0;  ///< Σ ψ′(z)
  /// m: Σ of the squares of each parameter's derivatives, weighted as in `matrix`, but before the planes were
  /// projected out.
  Eigen::VectorXd squares;
  /// For each division m × blocks: the score contributions of each block's beams to `vector`, for its
  /// empirical covariance. Empty if no divisions were named.
  std::vector<Eigen::MatrixXd> block_scores;
  /// [m²] m: Σ of the squares of what a unit of each parameter changes ranges by, each beam alike. Zero if no
  /// divisions were named, too.
  Eigen::VectorXd range_squares;
  Eigen::VectorXd changed;  ///< m: how many beams that are

  explicit NormalEquations(std::size_t parameters = 0, const std::vector<std::size_t>& blocks = {});
  NormalEquations& operator+=(const NormalEquations& other);

  /// By what the inverse of `matrix` is to be multiplied to be the covariance of θ (Huber): it holds for
  /// whatever noise the residuals show, and for the beams that count less.
  double covariance_factor() const;

  /// q × blocks: what the blocks of a division contribute to `vector` along q directions of some parameters,
  /// in units in which the Σ of the products over the blocks has the expectation
  /// covariance_factor() · directionsᵀ matrix directions if all errors are independent.
  ///
  /// @param of          p parameters
  /// @param directions  p × q
  Eigen::MatrixXd scores_along(std::size_t division, const std::vector<std::size_t>& of,
                               const Eigen::MatrixXd& directions) const;

  /// The equations of the parameters `kept`, in this order, after those in `eliminated` have been projected
  /// out in turn, so that what they could explain no longer counts. The others are held as they are. What
  /// `eliminated` leaves undetermined is left alone.
  NormalEquations reduced(const std::vector<std::size_t>& kept,
                          const std::vector<std::size_t>& eliminated) const;
};

/// Derivatives by the sensor model: how parameters move points across a surfel.
///
/// @param surfel        whose normal counts
/// @param beams         some of its beams
/// @param range_change  [m] for each, the range change that puts its end on the plane. The
///                      derivatives are taken there and not at the noisy point: noise
///                      in the regressors would bias the parameters.
/// @param rows          for each beam, m numbers: normal · ∂x/∂θₖ; to be filled, zero at first
/// Called from several threads at once.
using DerivativeRows = std::function<void(const Surfel& surfel, std::span<const std::uint32_t> beams,
                                          std::span<const double> range_change, std::span<double> rows)>;

/// Adds up the equations of all surfels. Deterministic, on any number of threads.
///
/// @param divisions  what errors beams may share; or none: see NormalEquations::block_scores
NormalEquations normal_equations(const Surfels& surfels, const BeamsView& beams, std::size_t parameters,
                                 const DerivativeRows& derivatives, const SurfelSettings& settings,
                                 std::span<const Division> divisions = {});

}  // namespace crisp::quality
