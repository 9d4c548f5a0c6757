// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/model/residual_histogram.hpp"

namespace crisp::diagnose {

/// Density plot of one laser's standardized residuals, with bars of ± 2 standard errors: measured, simulated,
/// and measured with the extended model.
///
/// @param after  null, or equal to `before`, if the model was not extended; it is left out then
plot::Plot distribution_plot(const std::string& name, const Distribution& before, const Distribution* after);

}  // namespace crisp::diagnose
