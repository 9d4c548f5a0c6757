// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include <crisp/points.hpp>

namespace crisp {

class Search;

/// Settings of rqe().
struct RqeSettings {
  double sigma = 0.03;      ///< [m] width of the kernel that stands for each point
  double cutoff = 7;        ///< [σ] distance beyond which a pair counts as 0
  bool gradient = true;     ///< whether to compute it
  bool error_bound = true;  ///< whether to compute it
};

/// Rényi's quadratic entropy of a cloud; the lower, the sharper the cloud.
struct Rqe {
  double value = 0;          ///< H = −log E [nat; E in 1/m³]
  double energy = 0;         ///< E [1/m³]: the chance density that two points drawn at random coincide
  double error_bound = 0;    ///< bound of |value − H with the whole kernel|; 0 if not requested
  Vectors gradient;          ///< ∂H/∂x of each point [1/m]; empty if not requested
  std::uint64_t pairs = 0;   ///< pairs i < j nearer than the cut-off; 0 if none were formed
  std::uint64_t tested = 0;  ///< distances computed to find them, see Search::sums
};

/// Rényi's quadratic entropy with isotropic Gaussian kernels, equations (10) and (11) of Sheehan, Harrison
/// and Newman, "Self-calibration for a 3D laser" (IJRR 2012), over all pairs, i = j included:
///
///     E = Σᵢ Σⱼ wᵢ wⱼ K(|xᵢ − xⱼ|) / (Σ w)²,   H = −log E
///
/// The paper's kernel G(·, 2σ²I) is cut at R = cutoff · σ: K(d) = G(d) − G(R) for d < R, else 0. Lowering it
/// by G(R) keeps E continuous where a pair crosses R, so that the gradient is exactly that of the value.
/// E is then too small by at most G(R) a pair; `error_bound` is the resulting bound for these data. A wide
/// kernel, under which a point has thousands of neighbours, is not cut but summed on a lattice.
///
/// @param points   n points [m], n ≥ 1
/// @param weights  n weights, scaled at will (only their ratios count), or none: all 1
/// @throws Error   for no points, coordinates or weights that are no numbers, and settings out of range.
/// The result is the same, to the last bit, on any number of threads.
Rqe rqe(const PointsView& points, std::span<const double> weights, const RqeSettings& settings);

/// The same with another search than "grid". One that is used again for points that have moved a little may
/// save work; the result then depends, in its rounding, on what it was used for before.
Rqe rqe(const PointsView& points, std::span<const double> weights, const RqeSettings& settings,
        Search& search);

}  // namespace crisp
