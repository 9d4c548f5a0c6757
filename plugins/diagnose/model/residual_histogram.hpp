// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "pipeline/statistics/histogram.hpp"
#include "plugins/diagnose/model/residuals.hpp"

namespace crisp::diagnose {

/// Histogram density of one laser's standardized residuals, measured and simulated.
struct Distribution {
  std::size_t laser = 0;
  struct Bin {
    double at = 0;         ///< centre of the bin
    double measured = 0;   ///< density
    double simulated = 0;  ///< density over all simulations
    double error = 0;      ///< standard error of the measured density
  };
  std::vector<Bin> bins;
  double single = 0;  ///< density of a single measured residual
  double measured_rms = 0;
  double simulated_rms = 0;
};

/// Histogram of one laser's standardized residuals.
struct NoiseCounts {
  statistics::Histogram bins = {-6, 6, 48};
  double squares = 0;  ///< sum of squares
};

/// Counts the residuals of positive weight, per laser.
///
/// @param values  measured residuals, or simulated ones in their place
/// @param noise   of each residual, relative to the reported noise
std::vector<NoiseCounts> counts_of(const WeightedResiduals& values, const Residuals& residuals,
                                   const std::vector<double>& noise, const Measurements& beams);

/// Distributions of the lasers that have residuals.
///
/// @param simulated  counts of each simulation
std::vector<Distribution> distributions(const std::vector<NoiseCounts>& measured,
                                        const std::vector<std::vector<NoiseCounts>>& simulated);

}  // namespace crisp::diagnose
