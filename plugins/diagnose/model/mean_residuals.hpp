// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "plugins/diagnose/model/quantile_bins.hpp"
#include "plugins/diagnose/model/residuals.hpp"

namespace crisp::diagnose {

/// [m] Mean residual in each bin: one step of Tukey's M-estimator, with weights relative to each view's own
/// location. A profile of one laser is centred: the laser's common offset depends on no covariate and belongs
/// to the profile over lasers.
std::vector<double> means_in(const QuantileBins& layout, const WeightedResiduals& residuals);

/// p-value of a profile under the null hypothesis of noise alone: χ² over its bins, less one degree of
/// freedom where the mean was removed.
///
/// @param errors  [m] standard error of each mean
double profile_p_value(const QuantileBins& layout, const std::vector<double>& means,
                       const std::vector<double>& errors);

/// [m] RMS of some means, less the contribution of noise.
double systematic_rms(const std::vector<double>& means, const std::vector<double>& errors);

}  // namespace crisp::diagnose
