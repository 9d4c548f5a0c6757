// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>

#include <crisp/factory_registry.hpp>
#include <crisp/neighbour_search.hpp>
#include <crisp/points.hpp>

namespace crisp {

/// A measure's value for a cloud.
struct Quality {
  double value = 0;  ///< lower is better
  Vectors gradient;  ///< its derivative by each coordinate [1/m]; empty if not requested
};

/// How crisp a cloud is. A measure knows points and weights, and nothing of how they were taken.
class Measure {
 public:
  virtual ~Measure() = default;

  /// @param points   n points [m], n ≥ 1
  /// @param weights  how much each point counts, or none: all the same
  /// @param scale    [m] > 0: detail finer than this is to be seen, and coarser detail to be followed; an
  ///                 optimiser goes from wide to narrow
  /// @throws Error   for points, weights or a scale that cannot be measured
  /// A measure may keep what it learnt from one call to speed up the next; calls are from one thread at a
  /// time.
  virtual Quality evaluate(const PointsView& points, std::span<const double> weights, double scale,
                           bool gradient) = 0;
};

/// Settings of a measure; each measure uses those that apply to it.
struct MeasureSettings {
  std::string search = "grid";  ///< how neighbours are found, by its name in `searches`
  double cutoff = 7;            ///< [scale] beyond which points do not see each other
};

using MeasureRegistry = Registry<Measure, MeasureSettings, SearchRegistry>;

/// "rqe": Rényi's quadratic entropy, whose σ is the scale.
void register_built_in(MeasureRegistry& registry);

}  // namespace crisp
