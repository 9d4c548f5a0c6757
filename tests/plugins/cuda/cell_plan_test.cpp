// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/cuda/cell_plan.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/quality/awkward_clouds.hpp"

namespace crisp::cuda {
namespace {

TEST(CellPlan, HasEachSlotInOneUnitOfItsCell) {
  for (const auto& [what, cloud] : test::awkward_clouds()) {
    const CellPlan plan = plan_cells(cloud.view(), 0.1);
    std::uint32_t next = 0;
    for (const Unit& unit : plan.units) {
      EXPECT_EQ(unit.slots.first, next) << what;
      EXPECT_GT(unit.slots.last, unit.slots.first) << what;
      EXPECT_LE(unit.slots.last - unit.slots.first, kLanes) << what;
      for (std::uint32_t slot = unit.slots.first; slot < unit.slots.last; ++slot) {
        EXPECT_EQ(plan.order.cell[slot], plan.order.cell[unit.slots.first]) << what;
      }
      next = unit.slots.last;
    }
    EXPECT_EQ(next, cloud.size()) << what;
  }
}

TEST(CellPlan, ListsEveryNeighbourOnce) {
  for (const auto& [what, cloud] : test::awkward_clouds()) {
    const CellPlan plan = plan_cells(cloud.view(), 0.1);
    for (const Unit& unit : plan.units) {
      std::vector<int> seen(cloud.size());
      for (auto list = plan.near_begin[unit.cell]; list < plan.near_begin[unit.cell + 1]; ++list) {
        for (auto slot = plan.near[list].first; slot < plan.near[list].last; ++slot)
          ++seen[plan.order.index[slot]];
      }
      const std::uint32_t i = plan.order.index[unit.slots.first];
      for (std::size_t j = 0; j < cloud.size(); ++j) {
        EXPECT_LE(seen[j], 1) << what;
        const bool near = squared_distance(cloud.view(), i, j) < 0.1 * 0.1;
        EXPECT_GE(seen[j], near ? 1 : 0) << what;
      }
    }
  }
}

TEST(CellPlan, RequestsDoublePrecisionOnlyWhereACloudReachesVeryFar) {
  const auto clouds = test::awkward_clouds();
  EXPECT_FALSE(plan_cells(clouds.at("huge coordinates").view(), 0.1).needs_double);
  EXPECT_TRUE(plan_cells(clouds.at("outliers").view(), 0.1).needs_double);
}

TEST(CellPlan, OfNoPointsHasNoUnits) { EXPECT_TRUE(plan_cells({}, 1).units.empty()); }

}  // namespace
}  // namespace crisp::cuda
