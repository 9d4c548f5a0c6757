// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pipeline/model/beam.hpp"
#include "pipeline/model/terms/empirical.hpp"

namespace crisp {
namespace {

constexpr int kCount = 8;

TEST(Splines, HoldWhatIsStraight) {
  for (const double zero : {2.0, 3.0, 3.3}) {
    const Shape shape = Shape::splines(kCount, 2, 4, zero);
    const double pieces = kCount - 2;
    const double nearest = 1 + std::round((zero - 2) / 2 * pieces);
    std::vector<double> straight;  // of a uniform cubic B-spline: its middle, less that of the omitted one
    for (int k = 0; k <= kCount; ++k) {
      if (k != nearest) straight.push_back(2 * (k - nearest) / pieces);
    }
    const auto at = [&](double x) { return shape.at(x, std::span<const double>(straight)); };
    for (const double x : {2.0, 2.1, 2.74, 3.0, 3.66, 4.0}) EXPECT_NEAR(at(x), x - zero, 1e-14);
    EXPECT_NEAR(at(-3), 2 - zero, 1e-14) << "level beyond";
    EXPECT_NEAR(at(7), 4 - zero, 1e-14) << "level beyond";
  }
}

TEST(Splines, AreZeroWhereTheyAreRequestedToBe) {
  const std::vector<double> some{1, -2, 0.5, 3, 1, -1, 0.25, 2};
  for (const double zero : {0.0, 0.5, 0.71, 1.0})
    EXPECT_NEAR(Shape::splines(kCount, 0, 1, zero).at(zero, std::span<const double>(some)), 0, 1e-14);
}

TEST(Splines, AreTwoThirdsInTheirMiddlesAndASixthNextTo) {
  const Shape shape = Shape::splines(kCount, 0, 1, 0);
  std::vector<double> one(kCount, 0);
  one[3] = 1;  // the fifth, since the second is omitted
  EXPECT_NEAR(shape.at(3.0 / 6, std::span<const double>(one)), 2.0 / 3, 1e-14);
  EXPECT_NEAR(shape.at(2.0 / 6, std::span<const double>(one)), 1.0 / 6, 1e-14);
  EXPECT_NEAR(shape.at(4.0 / 6, std::span<const double>(one)), 1.0 / 6, 1e-14);
  EXPECT_EQ(shape.at(1.0 / 6, std::span<const double>(one)), 0);
}

TEST(Splines, HaveTheirDerivatives) {
  const Shape shape = Shape::splines(kCount, 0, 1, 0.5);
  const std::vector<double> some{1, -2, 0.5, 3, 1, -1, 0.25, 2};
  const std::vector<Jet> jets(some.begin(), some.end());
  constexpr double kStep = 1e-6;
  for (const double x : {0.01, 0.3, 0.6, 0.99}) {
    const auto value = [&](double at) { return shape.at(at, std::span<const double>(some)); };
    const Jet found = shape.at(Jet(x, 0), std::span<const Jet>(jets));
    EXPECT_NEAR(found.a, value(x), 1e-14);
    EXPECT_NEAR(found.v[0], (value(x + kStep) - value(x - kStep)) / (2 * kStep), 1e-6);
  }
}

}  // namespace
}  // namespace crisp
