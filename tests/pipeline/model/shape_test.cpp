// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numeric>

#include "pipeline/model/beam.hpp"
#include "pipeline/model/terms/empirical.hpp"

namespace crisp {
namespace {

constexpr int kCount = 9;

TEST(Splines, HoldWhatIsLevelAndWhatIsStraight) {
  const Shape shape = Shape::splines(kCount);
  const std::vector<double> level(kCount, 2.5);
  std::vector<double> straight(kCount);  // of a uniform cubic B-spline: the middle of each
  for (int k = 0; k < kCount; ++k) straight[static_cast<std::size_t>(k)] = (k - 1.0) / (kCount - 3);
  for (const double x : {0.0, 0.05, 0.37, 0.5, 0.83, 1.0}) {
    EXPECT_NEAR(shape.at(x, std::span<const double>(level)), 2.5, 1e-14);
    EXPECT_NEAR(shape.at(x, std::span<const double>(straight)), x, 1e-14);
  }
  for (const double x : {-3.0, 7.0}) {
    EXPECT_NEAR(shape.at(x, std::span<const double>(straight)), x < 0 ? 0 : 1, 1e-14) << "level beyond";
  }
}

TEST(Splines, AreTwoThirdsInTheirMiddlesAndASixthNextTo) {
  const Shape shape = Shape::splines(kCount);
  std::vector<double> one(kCount, 0);
  one[4] = 1;
  EXPECT_NEAR(shape.at(3.0 / 6, std::span<const double>(one)), 2.0 / 3, 1e-14);
  EXPECT_NEAR(shape.at(2.0 / 6, std::span<const double>(one)), 1.0 / 6, 1e-14);
  EXPECT_NEAR(shape.at(4.0 / 6, std::span<const double>(one)), 1.0 / 6, 1e-14);
  EXPECT_EQ(shape.at(1.0 / 6, std::span<const double>(one)), 0);
}

TEST(Splines, HaveTheirDerivatives) {
  const Shape shape = Shape::splines(kCount);
  const std::vector<double> some{1, -2, 0.5, 3, 1, -1, 0.25, 2, -3};
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
