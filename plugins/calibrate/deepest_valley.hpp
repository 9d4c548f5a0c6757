// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "plugins/calibrate/crispest.hpp"

namespace crisp {

/// How far two values of a parameter are from one another.
///
/// @param circular  whether it is an angle
double between(double a, double b, bool circular);

/// [nat] From where a valley is clearly less deep than the deepest. Two lasers whose clouds have nothing in
/// common are by log 2 less crisp than two that see the same; in ordinary rooms the next valley is 0.3 to 0.5
/// off.
inline constexpr double kClearlyDeeper = 0.1;

/// A kernel that narrows while a search goes on.
struct Narrowing {
  double from = 0.5;  ///< [m] σ at first
  double to = 0.1;    ///< [m] and at last
};

/// Another valley that a search could have ended in.
struct Rival {
  std::size_t parameter = 0;  ///< index into model.values()
  double at = 0;              ///< its value there
  double height = 0;          ///< [nat] by how much the cloud is less crisp there
};

/// The value of one parameter, others as they are, at which a cloud is crispest, wherever it starts: looks at
/// all of `grid` with the wide kernel, follows the few lowest valleys downhill while the kernel narrows, and
/// keeps the crispest end.
///
/// @return the next crispest end, if there is another
///
/// @param grid      evenly spaced, finer than valleys at the wide kernel are wide
/// @param circular  whether its last value is next to its first
std::optional<Rival> to_deepest_valley(SensorModel& model, std::size_t parameter,
                                       const std::vector<double>& grid, bool circular, const Sample& sample,
                                       Measure& measure, const SearchRange& range, const Narrowing& sigma);

}  // namespace crisp
