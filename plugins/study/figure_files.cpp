// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/figure_files.hpp"

#include <fmt/format.h>

#include "pipeline/data/degree.hpp"

namespace crisp::study {
namespace {

/// A line each with the cloud's points, blocks apart by two blank lines.
std::string beam_clouds(const Figures& figures) {
  std::string text =
      "# Figure 4: the cloud of the beam at -45 deg with no lag, and with the lag of least RQE\n";
  for (const BeamCloud* cloud : {&figures.before, &figures.after}) {
    text += fmt::format("# eta {:.6f} s\n# x [m]  y [m]\n", cloud->eta);
    for (const auto& point : cloud->points.colwise())
      text += fmt::format("{:.4f} {:.4f}\n", point.x(), point.y());
    text += "\n\n";
  }
  return text;
}

std::string surface(const FigureSettings& settings, const CostSurface& surface) {
  std::string text = fmt::format(
      "# Figure 5: RQE of both beams over tau and alpha, sigma {:g} m; the truth is 0.2 m, 0 deg\n"
      "# tau [m]  alpha [deg]  H [nat]\n",
      settings.sigma);
  for (std::size_t i = 0; i < settings.tau.steps; ++i) {
    for (std::size_t j = 0; j < settings.alpha.steps; ++j) {
      text += fmt::format("{:.5f} {:.4f} {:.6f}\n", settings.tau.at(i), settings.alpha.at(j) / data::kDegree,
                          surface.cost[i * settings.alpha.steps + j]);
    }
    text += "\n";
  }
  return text;
}

/// A column for each σ.
std::string curves(const std::string& title, const std::string& abscissa, const Axis& axis, double unit,
                   const std::vector<double>& widths, const CostCurves& curves) {
  std::string text = "# " + title + "\n# " + abscissa;
  for (const double sigma : widths) text += fmt::format("  H [nat] at sigma {:g} m", sigma);
  for (std::size_t i = 0; i < axis.steps; ++i) {
    text += fmt::format("\n{:.6f}", axis.at(i) / unit);
    for (const auto& curve : curves.cost) text += fmt::format(" {:.6f}", curve[i]);
  }
  return text + "\n";
}

std::string optima(const Figures& figures) {
  std::string text =
      "# Figure 6: minimum of RQE over tau and alpha; the truth is 0.2 m, 0 deg\n"
      "# sigma [m]  tau [m]  alpha [deg]\n";
  for (const Optimum& at : figures.optima) {
    text += fmt::format("{:g} {:.6f} {:.5f}\n", at.sigma, at.tau, at.alpha / data::kDegree);
  }
  return text;
}

}  // namespace

std::map<std::string, std::string> figure_files(const FigureSettings& settings, const Figures& figures) {
  return {
      {"fig4_beam.dat", beam_clouds(figures)},
      {"fig5_surface.dat", surface(settings, figures.surface)},
      {"fig6_tau.dat", curves("Figure 6: RQE over tau with the true alpha, at several sigma", "tau [m]",
                              settings.tau, 1, settings.widths, figures.over_tau)},
      {"fig6_alpha.dat", curves("Figure 6: RQE over alpha with the true tau, at several sigma", "alpha [deg]",
                                settings.alpha, data::kDegree, settings.widths, figures.over_alpha)},
      {"fig6_optimum.dat", optima(figures)},
      {"fig7_eta.dat",
       curves(
           fmt::format("Figure 7: RQE of the beam at -45 deg over eta, at several sigma; the truth is {:g} s",
                       settings.eta),
           "eta [s]", settings.lag, 1, settings.lag_widths, figures.over_lag)}};
}

}  // namespace crisp::study
