// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "plugins/diagnose/histogram.hpp"
#include "plugins/diagnose/residuals.hpp"

namespace crisp {

/// How one laser's residuals are distributed, each in units of its noise, beside simulated ones.
struct Distribution {
  std::size_t laser = 0;
  struct Bin {
    double at = 0;         ///< its middle
    double measured = 0;   ///< density
    double simulated = 0;  ///< density, of all simulations
    double error = 0;      ///< standard error of the measured density
  };
  std::vector<Bin> bins;
  double single = 0;  ///< the density that a single measured residual makes
  double measured_rms = 0;
  double simulated_rms = 0;
};

/// Counts of one laser's residuals in units of their noise.
struct NoiseCounts {
  Histogram bins = {-6, 6, 48};
  double squares = 0;  ///< their sum
};

/// Of each laser, those residuals whose weight is above zero.
///
/// @param values  of `residuals`: those measured, or others in their place
/// @param noise   of each residual, in units of what the surfels were told
std::vector<NoiseCounts> counts_of(const Weighed& values, const Residuals& residuals,
                                   const std::vector<double>& noise, const Measurements& beams);

/// Of each laser that has residuals.
///
/// @param simulated  of each simulation
std::vector<Distribution> distributions(const std::vector<NoiseCounts>& measured,
                                        const std::vector<std::vector<NoiseCounts>>& simulated);

}  // namespace crisp
