// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "plugins/calibrate/rqe_minimizer.hpp"

namespace crisp::calibrate {

/// Distance of two values of a parameter.
///
/// @param circular  whether it is an angle
double between(double a, double b, bool circular);

/// Values from reach below the centre to reach above, with as many steps to either side.
std::vector<double> grid_around(double centre, double reach, int steps);

/// The same with steps of at most `step`, two or more to either side.
std::vector<double> grid_of_step(double centre, double reach, double step);

/// [rad] Values around the circle.
std::vector<double> grid_on_circle(int steps);

/// [nat] Difference from which a local minimum is clearly higher than the lowest. Two lasers whose clouds
/// have nothing in common have an RQE that is log 2 above that of two that see the same; in ordinary rooms
/// the next local minimum is 0.3 to 0.5 higher.
inline constexpr double kClearlyDeeper = 0.1;

/// A kernel that narrows while a search goes on.
struct Narrowing {
  double from = 0.5;  ///< [m] σ at first
  double to = 0.1;    ///< [m] and at last
};

/// A competing local minimum.
struct CompetingMinimum {
  std::size_t parameter = 0;  ///< index into model.values()
  double at = 0;              ///< its value there
  double height = 0;          ///< [nat] by how much the cloud is less crisp there
};

/// Minimizes RQE over one parameter, the others held, independent of the start: evaluates all of `grid` with
/// the wide kernel, follows the few lowest local minima downhill while the kernel narrows, and keeps the
/// lowest end.
///
/// @return the next lowest end, if there is another
///
/// @param grid      evenly spaced, finer than the local minima at the wide kernel
/// @param circular  whether its last value is next to its first
std::optional<CompetingMinimum> multistart_search(SensorModel& model, std::size_t parameter,
                                                  const std::vector<double>& grid, bool circular,
                                                  const estimate::Sample& sample, Measure& measure,
                                                  const estimate::ParameterPrior& range,
                                                  const Narrowing& sigma);

}  // namespace crisp::calibrate
