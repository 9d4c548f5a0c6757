// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/ipopt_minimizer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::calibrate;

/// Rosenbrock's function: one minimum, of value 0, at (1, 1).
double rosenbrock(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  const double a = 1 - x[0];
  const double b = x[1] - x[0] * x[0];
  if (gradient) *gradient = Eigen::Vector2d(-2 * a - 400 * x[0] * b, 200 * b);
  return a * a + 100 * b * b;
}

Box wide_box() {
  return {
      .lower = Eigen::Vector2d(-5, -5), .upper = Eigen::Vector2d(5, 5), .basis = Eigen::Matrix2d::Identity()};
}

TEST(Minimize, FindsTheEndOfACurvedMinimum) {
  const auto minimum =
      minimize(rosenbrock, Eigen::Vector2d(-1.2, 1), wide_box(), {.max_iterations = 200, .tolerance = 1e-10});
  EXPECT_TRUE(minimum.converged) << minimum.status;
  EXPECT_NEAR(minimum.x[0], 1, 1e-4);
  EXPECT_NEAR(minimum.x[1], 1, 1e-4);
}

TEST(Minimize, StaysInsideTheBox) {
  Box box = wide_box();
  box.upper = Eigen::Vector2d(0.5, 5);
  const auto minimum =
      minimize(rosenbrock, Eigen::Vector2d(-1.2, 1), box, {.max_iterations = 200, .tolerance = 1e-10});
  EXPECT_NEAR(minimum.x[0], 0.5, 1e-4);
  EXPECT_NEAR(minimum.x[1], 0.25, 1e-3);
}

TEST(Minimize, DoesNotDependOnTheUnitsWhenTheBasisFitsThem) {
  // The first coordinate in units of 1/1000.
  const Objective in_milli = [](const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
    const double value = rosenbrock(Eigen::Vector2d(x[0] / 1000, x[1]), gradient);
    if (gradient) (*gradient)[0] /= 1000;
    return value;
  };
  const Box box{.lower = Eigen::Vector2d(-5000, -5),
                .upper = Eigen::Vector2d(5000, 5),
                .basis = Eigen::Vector2d(1000, 1).asDiagonal()};
  const auto minimum =
      minimize(in_milli, Eigen::Vector2d(-1200, 1), box, {.max_iterations = 200, .tolerance = 1e-10});
  EXPECT_NEAR(minimum.x[0], 1000, 0.1);
  EXPECT_NEAR(minimum.x[1], 1, 1e-4);
}

TEST(Minimize, StopsWhenItIsInterruptedWithTheBestSoFar) {
  int calls = 0;
  const auto minimum =
      minimize(rosenbrock, Eigen::Vector2d(-1.2, 1), wide_box(),
               {.max_iterations = 200, .tolerance = 1e-10, .interrupted = [&] { return ++calls > 3; }});
  EXPECT_EQ(minimum.status, "interrupted");
  EXPECT_LE(minimum.value, rosenbrock(Eigen::Vector2d(-1.2, 1), nullptr));
}

TEST(Minimize, RefusesAStartWhereTheCostIsNoNumber) {
  const Objective nowhere = [](const Eigen::VectorXd&, Eigen::VectorXd*) {
    return std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_THROW(minimize(nowhere, Eigen::Vector2d(0, 0), wide_box(), {}), Error);
  EXPECT_THROW(minimize(rosenbrock, Eigen::Vector3d(0, 0, 0), wide_box(), {}), Error);
}

}  // namespace
}  // namespace crisp
