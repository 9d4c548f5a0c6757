// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/bounded_step.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <random>

namespace crisp {
namespace {

using namespace crisp::estimate;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double objective(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& gradient,
                 const Eigen::VectorXd& step) {
  return gradient.dot(step) + 0.5 * step.dot(matrix * step);
}

struct Problem {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
  StepBounds bounds;
};

Problem drawn(std::uint64_t seed, Eigen::Index n) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, draw);
  return {.matrix = root * root.transpose() + 0.01 * Eigen::MatrixXd::Identity(n, n),
          .gradient = Eigen::VectorXd::NullaryExpr(n, draw),
          .bounds = {.lower = -Eigen::VectorXd::NullaryExpr(n, draw).cwiseAbs(),
                     .upper = Eigen::VectorXd::NullaryExpr(n, draw).cwiseAbs()}};
}

TEST(BoundedStep, IsNewtonsWithoutBounds) {
  Problem one = drawn(1, 5);
  one.bounds = {.lower = Eigen::VectorXd::Constant(5, -kInfinity),
                .upper = Eigen::VectorXd::Constant(5, kInfinity)};
  const Eigen::VectorXd newton = -one.matrix.ldlt().solve(one.gradient);
  EXPECT_NEAR((bounded_step(one.matrix, one.gradient, one.bounds) - newton).norm(), 0, 1e-9);
}

TEST(BoundedStep, MovesTheOthersToWhereTheBoundLeavesThem) {
  const Eigen::Matrix2d matrix{{1, 0.9}, {0.9, 1}};
  const Eigen::Vector2d gradient(-1, 0);  // the free step is (5.26, -4.74)
  const StepBounds bounds{.lower = Eigen::Vector2d(-kInfinity, -kInfinity),
                          .upper = Eigen::Vector2d(0, kInfinity)};
  const Eigen::VectorXd step = bounded_step(matrix, gradient, bounds);
  EXPECT_EQ(step[0], 0);
  EXPECT_NEAR(step[1], 0, 1e-12) << "clamped, it would be -4.74";
}

TEST(BoundedStep, HasNoBetterStepWithinTheBounds) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Problem one = drawn(seed, 3);
    const Eigen::VectorXd step = bounded_step(one.matrix, one.gradient, one.bounds);
    ASSERT_TRUE((step.array() >= one.bounds.lower.array()).all() &&
                (step.array() <= one.bounds.upper.array()).all());
    const double best = objective(one.matrix, one.gradient, step);
    constexpr int kGrid = 20;
    for (int a = 0; a <= kGrid; ++a) {
      for (int b = 0; b <= kGrid; ++b) {
        for (int c = 0; c <= kGrid; ++c) {
          const Eigen::Array3d share = Eigen::Array3d(a, b, c) / kGrid;
          const Eigen::VectorXd other =
              one.bounds.lower.array() + share * (one.bounds.upper - one.bounds.lower).array();
          ASSERT_LE(best, objective(one.matrix, one.gradient, other) + 1e-9) << "seed " << seed;
        }
      }
    }
  }
}

}  // namespace
}  // namespace crisp
