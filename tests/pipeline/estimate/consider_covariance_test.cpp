// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/consider_covariance.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>

namespace crisp {
namespace {

using namespace crisp::estimate;
using testing::ElementsAre;
using testing::Field;

TEST(ConsiderCovariance, WhatHangsOnAHeldParameterHasItsUncertaintyAndItsCombination) {
  // Rows of observations of (a, b, held): a + 5 held with σ = 0.1, and b with σ = 0.2.
  Eigen::MatrixXd rows(2, 3);
  rows << 1 / 0.1, 0, 5 / 0.1, 0, 1 / 0.2, 0;
  const Eigen::MatrixXd information = rows.transpose() * rows;
  const Eigen::MatrixXd covariance = information.topLeftCorner(2, 2).inverse();
  const ConsiderCovariance result =
      consider(covariance, information, {"a", "b", "held"}, Eigen::VectorXd::Constant(1, 2));
  EXPECT_NEAR(result.covariance(0, 0), 0.1 * 0.1 + 10 * 10, 1e-9);
  EXPECT_NEAR(result.covariance(1, 1), 0.2 * 0.2, 1e-12);
  EXPECT_THAT(result.dependent,
              ElementsAre(testing::AllOf(Field(&Unobservable::parameter, "a"),
                                         Field(&Unobservable::combination, "a + 5 * held"))));
}

TEST(ConsiderCovariance, WhatIsBetterKnownThanTheHeldMoveItStaysFree) {
  Eigen::MatrixXd rows(2, 3);
  rows << 1, 0, 1, 0, 1, 0;
  const Eigen::MatrixXd information = rows.transpose() * rows;
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(2, 2);
  const ConsiderCovariance result =
      consider(covariance, information, {"a", "b", "held"}, Eigen::VectorXd::Constant(1, 0.5));
  EXPECT_NEAR(result.covariance(0, 0), 1.25, 1e-12);
  EXPECT_TRUE(result.dependent.empty());
}

}  // namespace
}  // namespace crisp
