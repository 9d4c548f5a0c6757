// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/spatial_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/pipeline/quality/clouds.hpp"

namespace crisp {
namespace {

using namespace crisp::quality;

TEST(SpatialOrder, NumbersCellsAlongAMortonCurve) {
  // The curve's first steps: x, then y, then z.
  EXPECT_EQ(cell_key({0, 0, 0}), 0U);
  EXPECT_EQ(cell_key({1, 0, 0}), 1U);
  EXPECT_EQ(cell_key({0, 1, 0}), 2U);
  EXPECT_EQ(cell_key({0, 0, 1}), 4U);
  EXPECT_EQ(cell_key({3, 0, 1}), 1U + 8U + 4U);
  for (const CellLattice::Cell& cell : {CellLattice::Cell{5, 77, 1234}, {131071, 0, 131071}}) {
    EXPECT_EQ(cell_of(cell_key(cell)), cell);
  }
  EXPECT_EQ(cell_key({-1, 0, 0}), cell_key({0, 1 << 17, 0}));
}

TEST(SpatialOrder, CellsBelowZeroAreAsLargeAsOthers) {
  const CellLattice lattice{.low = {1, 2, 3}, .side = 0.5};
  EXPECT_EQ(lattice.cell(1.1, 2.6, 3.9), (CellLattice::Cell{0, 1, 1}));
  EXPECT_EQ(lattice.cell(0.9, 1.4, 2.0), (CellLattice::Cell{-1, -2, -2}));
}

TEST(SpatialOrder, HoldsEachPointOnceInTheOrderOfItsCells) {
  const auto cloud = test::random_cube(70000, 10, 1);  // more than one block
  const auto order = spatial_order(cloud.view(), 0.5);
  EXPECT_TRUE(std::ranges::is_sorted(order.cell));
  auto sorted = order.index;
  std::ranges::sort(sorted);
  for (std::uint32_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
  for (std::size_t k = 0; k < order.index.size(); ++k) {
    const std::uint32_t i = order.index[k];
    EXPECT_EQ(cell_key(order.lattice.cell(cloud.x[i], cloud.y[i], cloud.z[i])), order.cell[k]);
  }
}

TEST(SpatialOrder, PutsWhatLiesFarOutIntoTheOutermostCells) {
  Vectors cloud = test::random_cube(1000, 1, 2);
  test::add(cloud, 1e9, 0, 0);
  test::add(cloud, 2e9, 0, 0);
  test::add(cloud, -1e12, 0, 0);
  const auto order = spatial_order(cloud.view(), 0.1);
  const auto cell_of_point = [&](std::uint32_t i) {
    return cell_of(
        order.cell[static_cast<std::size_t>(std::ranges::find(order.index, i) - order.index.begin())]);
  };
  EXPECT_EQ(cell_of_point(1000), cell_of_point(1001));
  EXPECT_EQ(cell_of_point(1002)[0], 0);
  EXPECT_GT(cell_of_point(1000)[0], cell_of_point(5)[0]);
}

}  // namespace
}  // namespace crisp
