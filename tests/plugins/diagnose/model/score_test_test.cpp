// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/score_test.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/plugins/diagnose/model/least_squares.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::quality;

/// Normal equations of n residuals with random derivatives and parameters `truth`.
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

TEST(ScoreTest, EstimatesParametersWithinTheirErrors) {
  const Eigen::Vector3d truth(0.2, -0.1, 0.3);
  const auto equations = random_problem(truth, 5000, 1).reduced({0, 1, 2}, {});
  const ScoreTest test = score_test(equations, {0, 2});
  const auto own = score_test(equations.reduced({0, 2}, {1}), {0, 1});
  for (const Eigen::Index k : {0, 1}) {
    EXPECT_NEAR(own.value[k], truth[2 * k], 4 / std::sqrt(5000.0));
    EXPECT_NEAR(std::sqrt(own.covariance(k, k)), 1 / std::sqrt(5000.0), 0.15 / std::sqrt(5000.0));
  }
  EXPECT_NEAR(own.gain, 5000 * (0.04 + 0.09), 4 * std::sqrt(4 * 650.0));
  EXPECT_NEAR(test.identifiability(), 1, 0.1);
}

TEST(ScoreTest, HasAUniformPValueUnderTheNullHypothesis) {
  int small = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const auto equations = random_problem(Eigen::Vector2d::Zero(), 2000, seed);
    small += score_test(equations, {0, 1}).p_value < 0.1 ? 1 : 0;
  }
  EXPECT_NEAR(small, 40, 4 * 6);  // binomial: √(400 · 0.1 · 0.9) = 6
}

/// Twelve parameters, all of size `truth`, with one beam per block. Block scores contain the residuals only,
/// as for a model that has the parameters.
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
  equations.block_scores[0] = rows.transpose() * left.asDiagonal();
  equations.influence = noise.squaredNorm();
  equations.beams = static_cast<std::size_t>(blocks);
  equations.degrees_of_freedom = equations.weight = equations.stiffness = static_cast<double>(blocks);
  return equations;
}

double p_of_twelve(Eigen::Index blocks, double truth, unsigned seed) {
  std::vector<std::size_t> all(12);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return score_test(twelve_of_few(blocks, truth, seed), all).p_value;
}

TEST(ScoreTest, HasAUniformPValueForFewBlocks) {
  for (const Eigen::Index blocks : {100, 50, 25}) {
    int small = 0;
    for (unsigned seed = 1; seed <= 1000; ++seed) small += p_of_twelve(blocks, 0, seed) < 0.01 ? 1 : 0;
    EXPECT_LT(small, 10 + 4 * 3.2) << blocks << ": by χ² with twelve degrees of freedom it would be hundreds";
    EXPECT_TRUE(blocks < 100 || small > 0);
  }
}

TEST(ScoreTest, DetectsALargeEffectWithFewBlocks) {
  int sure = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) sure += p_of_twelve(30, 5, seed) < 1e-3 ? 1 : 0;
  EXPECT_GT(sure, 90) << "62 by Hotelling's T² alone";
}

TEST(ScoreTest, DetectsAVeryLargeEffectWithHardlyMoreBlocksThanParameters) {
  int sure = 0;
  int small = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    sure += p_of_twelve(14, 50, seed) < 1e-4 ? 1 : 0;
    small += p_of_twelve(14, 0, seed) < 0.01 ? 1 : 0;
  }
  EXPECT_GT(sure, 90) << "the errors' excess is at most a hundred";
  EXPECT_LE(small, 1 + 4) << "1 ± 1 by chance";
}

TEST(ScoreTest, IsNotSureWhereAnotherDivisionHasEnoughBlocksAndALargeExcess) {
  // Two of three blocks share nearly all of the errors, so that these cannot show the excess: a hundred can.
  auto equations = random_problem(Eigen::Vector2d(2, 2), 5000, 7).reduced({0, 1}, {});
  const Eigen::MatrixXd scores = 70 * equations.block_scores[0];
  Eigen::MatrixXd few = Eigen::MatrixXd::Zero(2, 3);
  for (Eigen::Index block = 0; block < scores.cols(); ++block) few.col(block % 3) += scores.col(block);
  equations.block_scores = {few};
  EXPECT_LT(score_test(equations, {0, 1}).p_value, 1e-3);
  equations.block_scores.push_back(scores);
  EXPECT_GT(score_test(equations, {0, 1}).p_value, 1e-3);
}

TEST(ScoreTest, UsesTheDivisionOfTheLargestPValue) {
  // Ten consecutive blocks share an error, which the other division shows: standard errors are √10 times as
  // large.
  auto equations = random_problem(Eigen::Vector2d(0.3, 0), 20000, 5);
  const ScoreTest alone = score_test(equations, {0, 1});
  Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(2, 200);
  for (Eigen::Index block = 0; block < 2000; ++block) {
    shared.col(block / 10) += std::sqrt(10) * equations.block_scores[0].col(block);
  }
  equations.block_scores.push_back(shared);
  const ScoreTest test = score_test(equations, {0, 1});
  EXPECT_EQ(test.value, alone.value);
  EXPECT_NEAR(alone.wald / test.wald, 10, 4) << "from 200 and 2000 squares";
  EXPECT_NEAR(test.covariance(0, 0) / alone.covariance(0, 0), 10, 4);
  EXPECT_NEAR(test.design_effect(), 10, 4);
  EXPECT_EQ(alone.design_effect(), 1);
  std::swap(equations.block_scores[0], equations.block_scores[1]);
  EXPECT_EQ(score_test(equations, {0, 1}).wald, test.wald);
}

TEST(ScoreTest, HoldsUnobservableDirectionsAtZero) {
  auto equations = random_problem(Eigen::Vector2d(1, 1), 1000, 3);
  // The second parameter has no effect after elimination.
  equations.matrix.col(1).setConstant(1e-9);
  equations.matrix.row(1).setConstant(1e-9);
  const ScoreTest test = score_test(equations, {1});
  EXPECT_EQ(test.value[0], 0);
  EXPECT_EQ(test.p_value, 1);
  EXPECT_TRUE(std::isinf(test.ranges_error));
}

}  // namespace
}  // namespace crisp
