// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/spot.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace crisp {
namespace {

using namespace crisp::simulate;

constexpr NoiseEffects kLms{.divergence = 0.014, .aperture = 0.008};

Surface wall(double x, double from_y, double to_y) {
  return {.name = "wall",
          .corners = {{x, from_y, -5}, {x, to_y, -5}, {x, to_y, 5}, {x, from_y, 5}},
          .reflectance = 0.5};
}

/// The near half plane y < 0 at x = 4 hides the left half of a wall at x = 4 + `behind`.
Scene edge(double behind) { return {"edge", {wall(4, -5, 0), wall(4 + behind, -5, 5)}}; }

/// What a laser hears whose beam would meet x = 4 at this y.
std::optional<SpotEcho> echo(const Scene& scene, const NoiseEffects& effects, double y) {
  return Spot(effects, 50, {0.5, 0.5}).echo(RayCaster(scene), {{0, y, 0}, Eigen::Vector3d::UnitX()});
}

TEST(Spot, SeesAPlaneAsAThinBeamDoes) {
  for (const double y : {-2.0, -0.1, 0.1, 2.0}) {
    const auto wide = echo(edge(0.3), kLms, y);
    const auto thin = echo(edge(0.3), {}, y);
    ASSERT_TRUE(wide && thin);
    EXPECT_EQ(wide->hit.distance, thin->hit.distance);
    EXPECT_EQ(wide->strength, thin->strength);
  }
}

TEST(Spot, MixesWhatLiesBeforeAndBehindAnEdge) {
  // The spot at 4 m is 64 mm wide: its outer rays are 22.5 mm off the middle, so that 5 mm off the edge
  // part of them meet the other wall.
  for (const double y : {-0.005, 0.005}) {
    const auto mixed = echo(edge(0.3), kLms, y);
    ASSERT_TRUE(mixed);
    EXPECT_GT(mixed->hit.distance, 4.05);
    EXPECT_LT(mixed->hit.distance, 4.25);
    EXPECT_EQ(echo(edge(0.3), {}, y)->hit.distance, y < 0 ? 4 : 4.3);
  }
  EXPECT_EQ(echo(edge(0.3), kLms, -0.03)->hit.distance, 4) << "all seven rays meet the near wall";
}

TEST(Spot, MixesByTheLightThatComesBack) {
  // 5 mm left of the edge two of seven rays (those at ±30° or ±60° from y, as the spot happens to lie) or
  // three pass it: the mean of their distances by 1 / (1 + (d/10)²).
  const auto mixed = echo(edge(0.3), kLms, -0.005);
  const auto mean = [](int passing) {
    const double near = (7 - passing) / (1 + 0.16), far = passing / (1 + 0.1849);
    return (near * 4 + far * 4.3) / (near + far);
  };
  const double d = mixed->hit.distance;
  EXPECT_TRUE(std::abs(d - mean(2)) < 1e-3 || std::abs(d - mean(3)) < 1e-3) << d;
}

TEST(Spot, HearsTheStrongestOfEchoesThatAreFarApart) {
  EXPECT_NEAR(echo(edge(3), kLms, -0.005)->hit.distance, 4, 1e-3);
  const auto far = echo(edge(3), kLms, 0.02);
  EXPECT_NEAR(far->hit.distance, 7, 1e-2);
  EXPECT_LT(far->strength, echo(edge(3), {}, 0.02)->strength) << "part of the light is in the other echo";
}

TEST(Spot, HearsAnEdgeBeforeNothing) {
  const Scene pole{"pole", {wall(4, -5, 0), wall(100, -1, 1)}};
  EXPECT_FALSE(echo(pole, {}, 0.005));
  const auto grazed = echo(pole, kLms, 0.005);
  ASSERT_TRUE(grazed);
  EXPECT_NEAR(grazed->hit.distance, 4, 1e-3);
  EXPECT_LT(grazed->strength, 0.5 * echo(pole, {}, -1)->strength);
}

}  // namespace
}  // namespace crisp
