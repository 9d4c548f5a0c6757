// SPDX-License-Identifier: BSD-3-Clause
// Mixed pixels are a property of the laser: they occur at all edges, not at a single one.
#include "plugins/diagnose/scene/mixed_pixels.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace crisp {
namespace {

using namespace crisp::diagnose;

Crossings crossings_of(const std::vector<Edge>& edges) {
  Crossings all;
  for (std::size_t number = 0; number < edges.size(); ++number) {
    for (int k = 0; k < edges[number].crossings; ++k) {
      all.mixed.push_back(k < edges[number].mixed);
      all.edges.push_back(number);
    }
  }
  return all;
}

TEST(MixedShare, HasAStandardErrorThatCoversTheScatterOfEdges) {
  std::mt19937_64 random(1);
  constexpr int kDraws = 400;
  constexpr double kMean = 0.3;
  int covered = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<Edge> edges;
    for (int k = 0; k < 12; ++k) {
      const double share = std::uniform_real_distribution<>(0, 2 * kMean)(random);
      const int crossings = std::uniform_int_distribution<>(5, 40)(random);
      const int mixed = std::binomial_distribution<>(crossings, share)(random);
      edges.push_back({.crossings = double(crossings), .mixed = double(mixed)});
    }
    const MixedShare share = mixed_share(edges);
    EXPECT_GT(share.degrees_of_freedom, 5);
    EXPECT_LT(share.degrees_of_freedom, 11);
    covered += std::abs(share.value - kMean) < share.std_error ? 1 : 0;
  }
  EXPECT_NEAR(covered / double{kDraws}, 0.66, 0.08) << "one standard error of a t-distribution";
}

TEST(MixedPixels, OfASingleEdgeAreThoseOfAnObjectThere) {
  // The first edge is a box whose side faces the laser edge-on: three beams a scan end on it.
  const std::vector<Edge> edges = {{51, 44}, {22, 0}, {7, 0}, {6, 0}, {5, 0}, {3, 0}, {1, 1}, {1, 0}, {1, 0}};
  EXPECT_FALSE(mixed_pixels("front", crossings_of(edges)));
  EXPECT_FALSE(mixed_pixels("front", crossings_of({{100, 90}}))) << "no other edge shows whether it has them";
}

TEST(MixedPixels, OfAllEdgesAreNamed) {
  const std::vector<Edge> edges = {{30, 12}, {22, 7}, {7, 3}, {16, 7}, {15, 5}, {13, 4}, {11, 5}, {8, 3}};
  const auto found = mixed_pixels("front", crossings_of(edges));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cause, "noise.mixed_pixels");
  EXPECT_NEAR(found->parameters.front().value, 46.0 / 122, 1e-9);
  EXPECT_LT(found->p_value, 0.002);
}

}  // namespace
}  // namespace crisp
