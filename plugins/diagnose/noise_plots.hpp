// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/edges.hpp"
#include "plugins/diagnose/noise.hpp"
#include "plugins/diagnose/repeats.hpp"

namespace crisp {

/// How one laser's ranges scatter, measured beside the normal law and the one that was found, if it is
/// another: the distribution of their errors, as its density on a logarithmic axis, and their RMS over the
/// range and, where they are known and change, over incidence and remission, in bins of equally many ranges.
/// Bars are two standard errors either way.
std::vector<Plot> noise_plots(const std::string& name, const RangeErrors& errors,
                              const NoiseDiagnosis& noise);

/// How much of a laser's ranges is beyond the last whole step, beside ranges of any size.
///
/// @param ranges  [m]
/// @param step    [m]
Plot comb_plot(const std::string& name, std::span<const float> ranges, double step);

/// Where between the two sides of an edge ranges end in thin air.
Plot edge_plot(const std::string& name, const Crossings& edges);

/// When directions were hidden that show a surface at other times.
Plot moving_plot(const ChangingDirections& directions);

}  // namespace crisp
