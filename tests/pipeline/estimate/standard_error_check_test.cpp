// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/standard_error_check.hpp"

#include <gmock/gmock.h>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::estimate;

TEST(StandardErrors, BelowWhatTheBeamsAllowAreAFault) {
  Measurements beams;
  beams.range.assign(10000, 5.0F);
  Outcome outcome{.model = SensorModel(nominal_calibration(default_rig())),
                  .free = {7},
                  .covariance = {},
                  .unobservable = {}};
  const auto with_error = [&](double seconds) {
    outcome.covariance = Eigen::MatrixXd::Constant(1, 1, seconds * seconds);
    check_errors(outcome, beams, 0.002, {});
  };
  EXPECT_NO_THROW(with_error(1e-6));
  EXPECT_THROW(with_error(1e-10), Error);
}

}  // namespace
}  // namespace crisp
