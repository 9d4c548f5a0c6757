// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Sums of least squares against surfels over the beams of each.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/quality/surfel_equations.hpp"
#include "pipeline/quality/surfel_residuals.hpp"

namespace crisp::quality {

/// Sums over beams by the moment that each is of, for the moments from `first` on.
struct SumsByMoment {
  std::uint32_t first = 0;
  Eigen::MatrixXd sums;  ///< a column each moment

  SumsByMoment() = default;
  SumsByMoment(std::uint32_t first_moment, std::uint32_t last_moment, Eigen::Index rows);
  auto of(std::uint32_t moment) { return sums.col(static_cast<Eigen::Index>(moment - first)); }
  SumsByMoment& operator+=(const SumsByMoment& other);
};

/// Sums by block of a division, for the blocks that a surfel's beams are of.
struct SumsByBlock {
  std::vector<std::uint32_t> blocks;  ///< ascending
  Eigen::MatrixXd sums;               ///< a column each block
};

/// Each beam has a row: the three parameters of the surfel's plane, the distance, and the derivatives by the
/// m parameters, all by √weight / spread; and what a turn about the z axis moves it by, likewise.
struct SurfelSums {
  Eigen::MatrixXd gram;                   ///< (m + 4)²: Σ rowᵀ row
  Eigen::VectorXd range_squares;          ///< [m²] m: see NormalEquations
  Eigen::VectorXd changed;                ///< m: likewise
  std::vector<SumsByBlock> block_scores;  ///< of each division m + 4 a block: Σ rowᵀ distance
  SumsByMoment turns;                     ///< m + 5 a moment: Σ rowᵀ turn, and Σ turn² at last
};

/// The summands of a surfel's beams.
struct SurfelSummands {
  std::size_t parameters = 0;
  const DerivativeRows& derivatives;
  std::span<const Division> divisions = {};
  std::span<const std::uint32_t> views = {};      ///< of each beam; or none: see BeamsView
  std::span<const std::uint32_t> moment_of = {};  ///< for each beam; or none
};

/// Deterministic, on any number of threads.
SurfelSums sums_of(const Surfel& surfel, std::span<const std::uint32_t> members,
                   std::span<const SurfelResidual> residuals, const SurfelSummands& summands);

}  // namespace crisp::quality
