// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/looks.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/plugins/diagnose/least_squares.hpp"

namespace crisp {
namespace {

/// Least squares of `truth` in n residuals with random derivatives.
NormalEquations random_problem(const Eigen::VectorXd& truth, Eigen::Index n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const Eigen::Index m = truth.size();
  test::LeastSquares problem(m, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::VectorXd row(m);
    for (double& value : row) value = normal(random);
    const double noise = normal(random);
    problem.add(row, noise - row.dot(truth), noise);
  }
  return problem.equations();
}

TEST(Look, FindsWhatIsThereWithItsErrors) {
  const Eigen::Vector3d truth(0.2, -0.1, 0.3);
  const auto equations = random_problem(truth, 5000, 1).reduced({0, 1, 2}, {});
  const Look look = look_at(equations, {0, 2});
  const auto own = look_at(equations.reduced({0, 2}, {1}), {0, 1});
  for (const Eigen::Index k : {0, 1}) {
    EXPECT_NEAR(own.value[k], truth[2 * k], 4 / std::sqrt(5000.0));
    EXPECT_NEAR(std::sqrt(own.covariance(k, k)), 1 / std::sqrt(5000.0), 0.15 / std::sqrt(5000.0));
  }
  EXPECT_NEAR(own.gain, 5000 * (0.04 + 0.09), 4 * std::sqrt(4 * 650.0));
  EXPECT_NEAR(look.identifiability(), 1, 0.1);
}

TEST(Look, HasAnEvenPValueWhereNothingIs) {
  int small = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const auto equations = random_problem(Eigen::Vector2d::Zero(), 2000, seed);
    small += look_at(equations, {0, 1}).p_value < 0.1 ? 1 : 0;
  }
  EXPECT_NEAR(small, 40, 4 * 6);  // binomial: √(400 · 0.1 · 0.9) = 6
}

/// Twelve parameters, all of them at `truth`, of as many beams as there are blocks. As where the model has
/// the parameters: pulls are of what they leave.
NormalEquations twelve_of_few(Eigen::Index blocks, double truth, unsigned seed) {
  constexpr Eigen::Index kParameters = 12;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  const Eigen::MatrixXd rows = Eigen::MatrixXd::NullaryExpr(blocks, kParameters, draw);
  const Eigen::VectorXd noise = Eigen::VectorXd::NullaryExpr(blocks, draw);
  const Eigen::VectorXd residuals = noise - rows * Eigen::VectorXd::Constant(kParameters, truth);
  NormalEquations equations(kParameters, {static_cast<std::size_t>(blocks)});
  equations.matrix = rows.transpose() * rows;
  equations.vector = rows.transpose() * residuals;
  equations.squares = equations.matrix.diagonal();
  const Eigen::VectorXd left = residuals - rows * equations.matrix.ldlt().solve(equations.vector);
  equations.pulls[0] = rows.transpose() * left.asDiagonal();
  equations.influence = noise.squaredNorm();
  equations.beams = static_cast<std::size_t>(blocks);
  equations.freedom = equations.weight = equations.stiffness = static_cast<double>(blocks);
  return equations;
}

double p_of_twelve(Eigen::Index blocks, double truth, unsigned seed) {
  std::vector<std::size_t> all(12);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return look_at(twelve_of_few(blocks, truth, seed), all).p_value;
}

TEST(Look, HasAnEvenPValueAlsoWhereBlocksAreFew) {
  for (const Eigen::Index blocks : {100, 50, 25}) {
    int small = 0;
    for (unsigned seed = 1; seed <= 1000; ++seed) small += p_of_twelve(blocks, 0, seed) < 0.01 ? 1 : 0;
    EXPECT_LT(small, 10 + 4 * 3.2) << blocks << ": by χ² of twelve freedoms it would be hundreds";
    EXPECT_TRUE(blocks < 100 || small > 0);
  }
}

TEST(Look, IsSureOfWhatIsLargeAlsoWhereBlocksAreFew) {
  int sure = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) sure += p_of_twelve(30, 5, seed) < 1e-3 ? 1 : 0;
  EXPECT_GT(sure, 90) << "by Hotelling's law alone 62";
}

TEST(Look, IsAsSureAsTheDivisionByWhichItIsLeastSure) {
  // Ten blocks after another share an error, which another division shows: errors are √10 times as large.
  auto equations = random_problem(Eigen::Vector2d(0.3, 0), 20000, 5);
  const Look alone = look_at(equations, {0, 1});
  Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(2, 200);
  for (Eigen::Index block = 0; block < 2000; ++block) {
    shared.col(block / 10) += std::sqrt(10) * equations.pulls[0].col(block);
  }
  equations.pulls.push_back(shared);
  const Look look = look_at(equations, {0, 1});
  EXPECT_EQ(look.value, alone.value);
  EXPECT_NEAR(alone.wald / look.wald, 10, 4) << "of 200 and 2000 squares";
  EXPECT_NEAR(look.covariance(0, 0) / alone.covariance(0, 0), 10, 4);
  EXPECT_NEAR(look.sharing(), 10, 4);
  EXPECT_EQ(alone.sharing(), 1);
  std::swap(equations.pulls[0], equations.pulls[1]);
  EXPECT_EQ(look_at(equations, {0, 1}).wald, look.wald);
}

TEST(Look, HoldsHiddenDirectionsAtZero) {
  auto equations = random_problem(Eigen::Vector2d(1, 1), 1000, 3);
  // The second does nothing that is left.
  equations.matrix.col(1).setConstant(1e-9);
  equations.matrix.row(1).setConstant(1e-9);
  const Look look = look_at(equations, {1});
  EXPECT_EQ(look.value[0], 0);
  EXPECT_EQ(look.p_value, 1);
  EXPECT_TRUE(std::isinf(look.ranges_error));
}

}  // namespace
}  // namespace crisp
