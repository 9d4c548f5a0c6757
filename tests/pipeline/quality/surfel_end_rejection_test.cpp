// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_end_rejection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/pipeline/quality/clouds.hpp"

namespace crisp {
namespace {

using namespace crisp::quality;

/// Beams that come in at 45° onto z = 0, where a surfel takes them all.
struct Face {
  Vectors points, directions;
  Surfels surfels;
  Surfel surfel{.middle = {0, 0, 0}, .normal = {0, 0, 1}, .u = {1, 0, 0}, .v = {0, 1, 0}, .radius = 0.5};
  std::mt19937_64 random;

  explicit Face(unsigned seed) : random(seed) {}

  /// @param depth  [m] below z = 0 where the beam ends that would meet z = 0 at (x, y)
  void add(double x, double y, double depth) {
    std::normal_distribution<double> noise(0, 0.012);
    const double further = depth + noise(random) * std::sqrt(0.5);
    test::add(points, x - further, y, -further);
    test::add(directions, -std::sqrt(0.5), 0, -std::sqrt(0.5));
    surfels.members.push_back(static_cast<std::uint32_t>(surfels.members.size()));
    surfels.weights.push_back(1);
  }

  /// An upright face of a column of 0.4 m, lying.
  void add_front(int beams) {
    std::uniform_real_distribution<double> across(-0.2, 0.2);
    std::uniform_real_distribution<double> up(-1, 1);
    for (int i = 0; i < beams; ++i) {
      const double x = across(random);
      add(x, up(random), 0);
    }
  }

  void cut() {
    surfel.end = static_cast<std::uint32_t>(surfels.members.size());
    surfels.surfels = {surfel};
    cut_strange_ends(surfel, surfels, {.points = points.view(), .directions = directions.view(), .views = {}},
                     {});
  }

  /// The number of beams from the first to the one before the last.
  long left(std::ptrdiff_t first, std::ptrdiff_t last) const {
    return std::count(surfels.weights.begin() + first, surfels.weights.begin() + last, 1.0);
  }
};

TEST(EndResiduals, AreCutWhereAFaceThatWasNotFoundBegins) {
  constexpr int kFront = 250;
  constexpr int kSide = 16;
  constexpr int kColumns = 20;
  long of_front = 0;
  long of_side = 0;
  for (unsigned seed = 1; seed <= kColumns; ++seed) {
    Face face(seed);
    face.add_front(kFront);
    // The column's other side goes straight down at x = 0.2. What ends on it within the gate of a surfel's
    // claims is claimed: 4.7 standard deviations of 12 mm.
    std::uniform_real_distribution<double> depth(0, 4.7 * 0.012);
    std::uniform_real_distribution<double> up(-1, 1);
    for (int i = 0; i < kSide; ++i) {
      const double down = depth(face.random);
      face.add(0.2 + down, up(face.random), down);
    }
    face.cut();
    of_front += face.left(0, kFront);
    of_side += face.left(kFront, kFront + kSide);
  }
  // The mean of what is off by 0 to d, evenly, is least likely from d/3 on: a third of the beams stays, the
  // least deep ones. Three standard deviations more, by chance.
  constexpr double kShare = 1.0 / 3;
  EXPECT_LE(of_side, kColumns * kSide * kShare + 3 * std::sqrt(kColumns * kSide * kShare * (1 - kShare)));
  EXPECT_GE(of_front, 99 * kColumns * kFront / 100);
}

TEST(EndResiduals, OfAPlainWallAreLeftAlone) {
  for (const int beams : {20, 100, 1000, 20000}) {
    long left = 0;
    constexpr int kWalls = 25;
    for (unsigned seed = 1; seed <= kWalls; ++seed) {
      Face wall(seed);
      wall.add_front(beams);
      wall.cut();
      left += wall.left(0, beams);
    }
    EXPECT_GE(left, 99L * kWalls * beams / 100) << beams;
  }
}

TEST(EndResiduals, OfBeamsThatDoNotCountAreNone) {
  Face face(1);
  face.add_front(30);
  std::ranges::fill(face.surfels.weights, 0);
  face.cut();
  EXPECT_EQ(face.left(0, 30), 0);
}

}  // namespace
}  // namespace crisp
