// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <crisp/neighbour_search.hpp>

#include "plugins/cuda/cell_plan.hpp"

namespace crisp::cuda {

/// Results of all units of a plan; see Results.
struct UnitSums {
  Vectors gradient;            ///< of each point; empty: unwanted
  std::vector<double> kernel;  ///< of each unit
  std::vector<std::uint64_t> pairs;
};

/// Calls sum_unit() for all units of a plan, in single precision unless the plan needs double.
using SumUnits = std::function<UnitSums(const PointsView& points, std::span<const double> weights,
                                        const PairKernel& kernel, bool gradient)>;

/// Readies a plan for whatever computes it. The plan must outlive what this returns.
using TakePlan = std::function<SumUnits(const CellPlan&)>;

/// RQE's sums by units, wherever they are computed. Truncated as "exact" and "flann" are, to a relative error
/// of some 1e-6 a pair; the same to the last bit each time. A plan is kept for points that have moved little
/// since it was made.
class UnitSearch final : public Search {
 public:
  explicit UnitSearch(TakePlan take_plan) : take_plan_(std::move(take_plan)) {}

  /// Same index as "grid": the processor makes the lists of neighbours.
  std::unique_ptr<NeighbourIndex> index(const PointsView& points, double radius) const override;
  GaussianSums sums(const PointsView& points, std::span<const double> weights,
                    const TruncatedGaussian& kernel, const RequestedSums& requested) override;

 private:
  struct Planned {
    double radius;  ///< [m] of the kernel
    Vectors at;     ///< [m] where points were
    CellPlan cells;
    SumUnits sum;
  };
  const Planned& planned_for(const PointsView& points, double radius);

  TakePlan take_plan_;
  std::unique_ptr<Planned> planned_;
};

}  // namespace crisp::cuda
