// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "plugins/study/monte_carlo_trial.hpp"

namespace crisp::study {

/// Evenly spaced values from `first` to `last`, both included.
struct Axis {
  double first = 0;
  double last = 0;
  std::size_t steps = 41;  ///< values, at least 2

  double at(std::size_t i) const {
    return first + (last - first) * static_cast<double>(i) / static_cast<double>(steps - 1);
  }
};

/// Settings of figures 4 to 7 of Sheehan, Harrison and Newman: one laser's two beams in the plate's plane, a
/// true lag to be estimated, and the ranges of its search.
struct FigureSettings {
  std::uint64_t seed = 1;
  double eta = -0.03;                                          ///< [s] the true lag
  Axis tau{.first = 0, .last = 0.5};                           ///< [m] the truth is 0.20 m
  Axis alpha{.first = -0.35, .last = 0.35};                    ///< [rad] the truth is 0
  Axis lag{.first = -0.1, .last = 0.1, .steps = 401};          ///< [s]
  double sigma = 0.1;                                          ///< [m] of the cost surface
  std::vector<double> widths = {0.1, 0.2, 0.5, 1, 2};          ///< [m] σ of figure 6
  std::vector<double> lag_widths = {0.5, 0.04, 0.012, 0.001};  ///< [m] σ of figure 7
};

/// A cost H [nat] over τ and α.
struct CostSurface {
  std::vector<double> cost;  ///< τ by τ: that of (i, j) is at i · α.steps + j
};

/// A family of costs H [nat], one curve a σ.
struct CostCurves {
  std::vector<std::vector<double>> cost;  ///< [σ][step]
};

/// Minimum of RQE over τ and α at one σ.
struct Optimum {
  double sigma = 0;  ///< [m]
  double tau = 0;    ///< [m]
  double alpha = 0;  ///< [rad]
};

/// The cloud of one beam, in the plate's plane.
struct BeamCloud {
  double eta = 0;  ///< [s] with which it was made
  Eigen::Matrix2Xd points;
};

struct Figures {
  BeamCloud before;             ///< figure 4: the front beam's cloud at η = 0
  BeamCloud after;              ///< and at the η of the least RQE, σ = 0.04 m
  CostSurface surface;          ///< figure 5: over τ and α
  CostCurves over_tau;          ///< figure 6: over τ with the true α, at each of the widths
  CostCurves over_alpha;        ///< over α with the true τ
  std::vector<Optimum> optima;  ///< and the optimum of both
  CostCurves over_lag;          ///< figure 7: of the front beam, over η, at each of the lag widths
};

/// Computes the figures' data. Figures 5 and 6 have η at the truth.
/// @param interrupted  polled between the parts; missing parts are then empty
Figures make_figures(const FigureSettings& settings, Measure& measure,
                     const std::function<bool()>& interrupted = {});

}  // namespace crisp::study
