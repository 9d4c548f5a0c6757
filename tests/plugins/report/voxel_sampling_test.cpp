// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/voxel_sampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace crisp {
namespace {

using namespace crisp::quality;
using namespace crisp::report;

constexpr double kSide = 0.1;  // [m]

/// Adds `count` points within a centimetre about a place on the x axis.
void add_heap(double x, std::size_t count, Vectors& to) {
  for (std::size_t k = 0; k < count; ++k) {
    to.x.push_back(x + 0.01 * static_cast<double>(k) / static_cast<double>(count));
    to.y.push_back(0.001);
    to.z.push_back(0.001);
  }
}

std::size_t chosen_at(double x, const Vectors& points, const std::vector<std::uint32_t>& chosen) {
  return static_cast<std::size_t>(
      std::ranges::count_if(chosen, [&](std::uint32_t i) { return std::abs(points.x[i] - x) < 0.05; }));
}

TEST(VoxelSampling, KeepsEquallyManyOfCrowdedCellsAndAllOfSparseOnes) {
  Vectors points;
  add_heap(1.02, 5000, points);
  add_heap(3.02, 300, points);
  add_heap(5.02, 10, points);
  const auto chosen = voxel_sample(spatial_order(points.view(), kSide), 210);
  EXPECT_EQ(chosen.size(), 210U);
  EXPECT_EQ(chosen_at(1.02, points, chosen), 100U);
  EXPECT_EQ(chosen_at(3.02, points, chosen), 100U);
  EXPECT_EQ(chosen_at(5.02, points, chosen), 10U);
}

TEST(VoxelSampling, KeepsEachPointOnceWhereThereAreNoMore) {
  Vectors points;
  add_heap(1.02, 7, points);
  add_heap(2.02, 3, points);
  const auto chosen = voxel_sample(spatial_order(points.view(), kSide), 100);
  EXPECT_EQ(chosen.size(), 10U);
  EXPECT_EQ(std::set(chosen.begin(), chosen.end()).size(), 10U);
}

TEST(VoxelSampling, UsesUpTheCountThatACapLeavesOver) {
  Vectors points;
  for (int heap = 0; heap < 3; ++heap) add_heap(1.02 + heap, 10, points);
  EXPECT_EQ(voxel_sample(spatial_order(points.view(), kSide), 14).size(), 14U);
}

}  // namespace
}  // namespace crisp
