// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/goodness_of_fit_tests.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace crisp {
namespace {

using namespace crisp::data;

TEST(FitStatistics, OfSeveralLasersTheWorstCountsAsOneOfThem) {
  const auto one = [](double before, double after) {
    return GoodnessOfFit{.scope = "laser1",
                         .before = {.tests = {{.covariate = "beam", .p_value = before}}, .p_value = before},
                         .after = {.tests = {{.covariate = "beam", .p_value = after}}, .p_value = after}};
  };
  Findings all;
  add_fit_statistics({one(0.1, 0.5), one(1e-9, 0.2)}, all);
  EXPECT_NEAR(all.before_p, 2e-9, 1e-15);
  EXPECT_NEAR(all.after_p, 0.36, 1e-12);  // 1 − 0.8²
  ASSERT_EQ(all.departures.size(), 1U);
  EXPECT_NEAR(all.departures[0].p_value, 2e-9, 1e-15);
  EXPECT_NEAR(all.departures[0].p_value_after, 0.36, 1e-12);
  Findings none;
  add_fit_statistics({}, none);
  EXPECT_TRUE(std::isnan(none.before_p)) << "nobody compared";
}

TEST(FitStatistics, OfTestsEachIsTheWorstOfSoMany) {
  const FitStatistics all =
      corrected({{.covariate = "beam", .p_value = 0.5}, {.covariate = "time", .p_value = 1e-8}});
  EXPECT_NEAR(all.tests[0].p_value, 0.75, 1e-12);  // 1 − 0.5²
  EXPECT_NEAR(all.tests[1].p_value, 2e-8, 1e-14);
  EXPECT_EQ(all.p_value, all.tests[1].p_value);
}

}  // namespace
}  // namespace crisp
