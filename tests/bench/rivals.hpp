// SPDX-License-Identifier: BSD-3-Clause
// RQE with its gradient as others would compute it: all to the same truncation, in one thread.
#pragma once

#include <crisp/points.hpp>

#include "pipeline/quality/truncation_bound.hpp"

namespace crisp::bench {

/// What all have to find: Σᵢ Σⱼ (G(xᵢ − xⱼ) − G(R)) / G(0) and its pulls, as in GaussianSums.
struct PairSums {
  double kernel = 0;
  Vectors gradient;
};

/// nanoflann's k-d tree, a radius search and std::exp a point: how most people would write it.
PairSums by_nanoflann(const Vectors& cloud, const TruncatedGaussian& kernel);

/// The same with PCL's pcl::KdTreeFLANN, in single precision as PCL's points are.
PairSums by_pcl(const Vectors& cloud, const TruncatedGaussian& kernel);

/// Every pair, in a loop that the compiler makes vectors of, its exponential included: single precision, and
/// the flags -march=native -ffast-math.
PairSums by_brute_force(const Vectors& cloud, const TruncatedGaussian& kernel);

}  // namespace crisp::bench
