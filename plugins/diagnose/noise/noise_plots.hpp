// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/noise/noise_diagnosis.hpp"
#include "plugins/diagnose/scene/mixed_pixels.hpp"
#include "plugins/diagnose/scene/visibility.hpp"

namespace crisp::diagnose {

/// Plots of one laser's range errors with the normal noise model and, if different, the identified one. They
/// show the density on a logarithmic axis, and the RMS error over range, incidence and remission (where known
/// and varying) in quantile bins. Bars are ± 2 standard errors.
std::vector<plot::Plot> noise_plots(const std::string& name, const RangeErrors& errors,
                                    const NoiseDiagnosis& noise);

/// Plot of the ranges' remainders modulo the quantization step, next to a uniform distribution.
///
/// @param ranges  [m]
/// @param step    [m]
plot::Plot quantization_plot(const std::string& name, std::span<const float> ranges, double step);

/// Plot of the relative position of mixed pixels between both sides of an edge.
plot::Plot edge_plot(const std::string& name, const Crossings& edges);

/// Plot of the times at which directions were occluded that show a surface otherwise.
plot::Plot moving_plot(const ChangingDirections& directions);

}  // namespace crisp::diagnose
