// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace crisp {

/// The kernel between two points of a cloud whose points are Gaussians of width σ each: the isotropic normal
/// density of variance 2σ² in three dimensions, lowered by its value at the cut-off radius and 0 beyond.
struct TruncatedGaussian {
  TruncatedGaussian(double sigma, double cutoff);  ///< @throws Error unless 0 < σ [m], 1 ≤ cutoff [σ] ≤ 12

  double radius = 0;    ///< [m] R
  double exponent = 0;  ///< [1/m²] 1/(4σ²): G(d) = peak · exp(−exponent · d²)
  double peak = 0;      ///< [1/m³] G(0)
  double floor = 0;     ///< G(R) / G(0)
};

/// What truncation leaves out, at most, of the sum over all pairs of wᵢ wⱼ G(xᵢ − xⱼ) / G(0).
///
/// @param sum_of_squares  Σ W² over the cells of a cubic lattice, W being the summed weight in a cell
/// @param side            [m] of the lattice's cells
///
/// For any two cells o apart, Σ W(A) W(A + o) ≤ Σ W(A)² (Cauchy and Schwarz), and a pair in them errs by
/// no more than G at R or at the least distance of such cells, whichever is lower. Summed over all o.
double truncation_bound(const TruncatedGaussian& kernel, double sum_of_squares, double side);

}  // namespace crisp
