// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/nonlinear_parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace crisp {
namespace {

using namespace crisp::diagnose;

using Others = std::vector<Candidate::OtherForm>;

Candidate::OtherForm other(double off, double behind) {
  return {.off = Eigen::Vector2d(off, -2 * off), .behind = behind};
}

TEST(FormCovariance, IsZeroIfOtherFormsExplainMuchLess) {
  EXPECT_EQ(form_covariance({}, 1).size(), 0);
  EXPECT_LT(form_covariance(Others{other(3, 100), other(-5, 200)}, 1).norm(), 1e-15);
}

TEST(FormCovariance, WeightsFormsByTheirLikelihood) {
  // Another form is equally likely: with probability 1/2 the parameters are off by 3 and 6.
  const Eigen::MatrixXd even = form_covariance(Others{other(3, 0)}, 1);
  EXPECT_NEAR(even(0, 0), 9.0 / 2, 1e-12);
  EXPECT_NEAR(even(1, 1), 36.0 / 2, 1e-12);
  EXPECT_NEAR(even(0, 1), -18.0 / 2, 1e-12);
  // Relative likelihood e⁻¹, normalized by 1 + e⁻¹.
  EXPECT_NEAR(form_covariance(Others{other(3, 2)}, 1)(0, 0), 9 * std::exp(-1) / (1 + std::exp(-1)), 1e-12);
}

TEST(FormCovariance, AccountsForTheDesignEffect) {
  EXPECT_NEAR(form_covariance(Others{other(3, 20)}, 10)(0, 0), form_covariance(Others{other(3, 2)}, 1)(0, 0),
              1e-12);
}

}  // namespace
}  // namespace crisp
