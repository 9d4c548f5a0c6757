// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report/residual_density_plot.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace crisp::diagnose {
namespace {

plot::PlotSeries measured_in(const Distribution& distribution, const std::string& when) {
  constexpr double kBar = 2;  // standard errors
  plot::PlotSeries measured{.name = "measured" + when, .x = {}, .y = {}};
  for (const Distribution::Bin& bin : distribution.bins) {
    measured.x.push_back(bin.at);
    measured.y.push_back(bin.measured);
    measured.error.push_back(kBar * bin.error);
  }
  return measured;
}

/// Simulated density, without bins that hardly any recording would fill: there are many simulations.
plot::PlotSeries simulated_in(const Distribution& distribution) {
  constexpr double kHardlyAny = 0.1;  // of the density of a single residual
  plot::PlotSeries simulated{.name = "simulated", .x = {}, .y = {}, .joined = false};
  for (const Distribution::Bin& bin : distribution.bins) {
    if (bin.simulated < kHardlyAny * distribution.single) continue;
    simulated.x.push_back(bin.at);
    simulated.y.push_back(bin.simulated);
  }
  return simulated;
}

bool measures_same(const Distribution& one, const Distribution& other) {
  return std::ranges::equal(one.bins, other.bins, {}, &Distribution::Bin::measured,
                            &Distribution::Bin::measured);
}

}  // namespace

plot::Plot distribution_plot(const std::string& name, const Distribution& before, const Distribution* after) {
  const bool is_extended = after && !measures_same(before, *after);
  plot::Plot plot{.title = fmt::format("{}: standardized residuals, RMS {:.2f} (simulated {:.2f})", name,
                                       before.measured_rms, before.simulated_rms),
                  .x_label = "residual [standard deviations of the noise]",
                  .y_label = "density, logarithmic",
                  .series = {measured_in(before, is_extended ? " before" : ""), simulated_in(before)},
                  .y_scale = plot::PlotScale::logarithmic};
  if (is_extended) {
    plot.title += fmt::format(", then {:.2f}", after->measured_rms);
    plot.series.push_back(measured_in(*after, " after"));
  }
  return plot;
}

}  // namespace crisp::diagnose
