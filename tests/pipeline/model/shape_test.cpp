// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/terms/shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <crisp/term.hpp>

namespace crisp {
namespace {

using namespace crisp::model;

constexpr int kCount = 8;

double at(const Shape& shape, double x, const std::vector<double>& coefficients) {
  return sum(shape.weights(x), std::span<const double>(coefficients));
}

TEST(Splines, HoldWhatIsStraight) {
  for (const double zero : {2.0, 3.0, 3.3}) {
    const Shape shape = Shape::splines(kCount, 2, 4, zero);
    const double pieces = kCount - 2;
    const double nearest = 1 + std::round((zero - 2) / 2 * pieces);
    std::vector<double> straight;  // of a uniform cubic B-spline: its middle, less that of the omitted one
    for (int k = 0; k <= kCount; ++k) {
      if (k != nearest) straight.push_back(2 * (k - nearest) / pieces);
    }
    for (const double x : {2.0, 2.1, 2.74, 3.0, 3.66, 4.0})
      EXPECT_NEAR(at(shape, x, straight), x - zero, 1e-14);
    EXPECT_NEAR(at(shape, -3, straight), 2 - zero, 1e-14) << "level beyond";
    EXPECT_NEAR(at(shape, 7, straight), 4 - zero, 1e-14) << "level beyond";
  }
}

TEST(Splines, AreZeroWhereTheyAreRequestedToBe) {
  const std::vector<double> some{1, -2, 0.5, 3, 1, -1, 0.25, 2};
  for (const double zero : {0.0, 0.5, 0.71, 1.0})
    EXPECT_NEAR(at(Shape::splines(kCount, 0, 1, zero), zero, some), 0, 1e-14);
}

TEST(Splines, AreTwoThirdsInTheirMiddlesAndASixthNextTo) {
  const Shape shape = Shape::splines(kCount, 0, 1, 0);
  std::vector<double> one(kCount, 0);
  one[3] = 1;  // the fifth, since the second is omitted
  EXPECT_NEAR(at(shape, 3.0 / 6, one), 2.0 / 3, 1e-14);
  EXPECT_NEAR(at(shape, 2.0 / 6, one), 1.0 / 6, 1e-14);
  EXPECT_NEAR(at(shape, 4.0 / 6, one), 1.0 / 6, 1e-14);
  EXPECT_EQ(at(shape, 1.0 / 6, one), 0);
}

TEST(Splines, HaveTheirDerivatives) {
  const Shape shape = Shape::splines(kCount, 0, 1, 0.5);
  const std::vector<double> some{1, -2, 0.5, 3, 1, -1, 0.25, 2};
  const std::vector<Jet> jets(some.begin(), some.end());
  constexpr double kStep = 1e-6;
  for (const double x : {0.01, 0.3, 0.6, 0.99}) {
    const auto value = [&](double there) { return at(shape, there, some); };
    const Jet found = sum(shape.weights(Jet(x, 0)), std::span<const Jet>(jets));
    EXPECT_NEAR(found.a, value(x), 1e-14);
    EXPECT_NEAR(found.v[0], (value(x + kStep) - value(x - kStep)) / (2 * kStep), 1e-6);
  }
}

TEST(Harmonics, BeginWithTheFirstRequested) {
  const Shape all = Shape::fourier(1, 4);
  const Shape some = Shape::fourier(2, 4);
  ASSERT_EQ(some.coefficients(), 6U);
  EXPECT_EQ(some.name(0), "cos2");
  const std::vector<double> coefficients{1, -2, 0.5, 3, 1, -1};
  const std::vector<double> with_first{0, 0, 1, -2, 0.5, 3, 1, -1};
  EXPECT_NEAR(at(some, 0.7, coefficients), at(all, 0.7, with_first), 1e-14);
}

TEST(Harmonics, AreCosinesAndSinesOfTheMultiples) {
  const Shape shape = Shape::fourier(1, 6);
  ASSERT_EQ(shape.coefficients(), 12U);
  for (const double x : {-3.0, -0.4, 0.0, 1.3, 40.0}) {
    for (std::size_t k = 0; k < 12; ++k) {
      std::vector<double> one(12, 0);
      one[k] = 1;
      const auto order = 1 + k / 2;
      const double turned = static_cast<double>(order) * x;
      EXPECT_NEAR(at(shape, x, one), k % 2 == 0 ? std::cos(turned) : std::sin(turned), 1e-13);
    }
  }
}

}  // namespace
}  // namespace crisp
