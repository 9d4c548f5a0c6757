// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/table.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::estimate;
using namespace crisp::study;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

MonteCarloTrial trial(double rqe_tau, double tau, double alpha_degrees) {
  return {.seed = 7,
          .parameters = {"laser1.tau", "laser1.alpha"},
          .bound = Eigen::Vector2d(0.003, 0.1 * kDegree),
          .bound_with_steps = Eigen::Vector2d(0.004, 0.2 * kDegree),
          .rqe = Estimate{.error = Eigen::Vector2d(rqe_tau, 0), .std_error = {}, .failure = {}},
          .refined = {.error = Eigen::Vector2d(tau, alpha_degrees * kDegree),
                      .std_error = Eigen::Vector2d(0.0015, 0.05 * kDegree),
                      .failure = {}}};
}

TEST(Table, HoldsMeansAndStandardDeviationsInMillimetresAndDegrees) {
  const Table table =
      table_of({trial(-0.002, 0.001, 0.04), trial(-0.004, 0.002, 0.06), trial(0, 0.003, 0.2)});
  EXPECT_EQ(table.runs, 3U);
  ASSERT_EQ(table.rows.size(), 2U);
  const ErrorRow& tau = table.rows[0];
  EXPECT_EQ(tau.parameter, "tau");
  EXPECT_NEAR(tau.rqe->mean, -2, 1e-12);
  EXPECT_NEAR(tau.rqe->std_dev, 2, 1e-12);
  EXPECT_NEAR(tau.refined.mean, 2, 1e-12);
  EXPECT_NEAR(tau.refined.std_dev, 1, 1e-12);
  EXPECT_NEAR(tau.bound, 3, 1e-12);
  EXPECT_NEAR(tau.bound_with_steps, 4, 1e-12);
  EXPECT_NEAR(tau.refined.one, 1.0 / 3, 1e-12);  // 1 of 1, 2 and 3 mm is within 1.5 mm
  EXPECT_NEAR(tau.refined.two, 2.0 / 3, 1e-12);  // and 2 within 2.94 mm
  EXPECT_NEAR(tau.refined.estimated, 1.5, 1e-12);
  ASSERT_TRUE(tau.paper);
  EXPECT_EQ(tau.paper->mean, 2.1);
  EXPECT_NEAR(table.rows[1].refined.mean, 0.1, 1e-12);
  EXPECT_NEAR(table.rows[1].bound, 0.1, 1e-12);
}

TEST(Table, LeavesRunsOutThatEndedElsewhereAndCountsThem) {
  MonteCarloTrial failed = trial(0, 0, 0);
  failed.refined = {.error = {}, .std_error = {}, .failure = "no walls"};
  const Table table =
      table_of({trial(0.3, 0.001, 0), trial(0.001, 0.001, 40), trial(0.001, 0.003, 0), failed});
  EXPECT_EQ(table.rqe_astray, 1U);
  EXPECT_EQ(table.refined_astray, 1U);
  EXPECT_EQ(table.refined_failed, 1U);
  EXPECT_NEAR(table.rows[0].rqe->mean, 2.0 / 3, 1e-12);
  EXPECT_NEAR(table.rows[0].refined.mean, 2, 1e-12);
  const std::string text = table_text(table);
  EXPECT_THAT(text, HasSubstr("4 runs; ended in another local minimum and left out: 1 (RQE), 1 (refined)"));
  EXPECT_THAT(text, HasSubstr("not refined: 1"));
}

TEST(Table, ComparesWithRunEstimatorsAndWithThePaperForItsScene) {
  std::vector<MonteCarloTrial> trials = {trial(-0.002, 0.001, 0.04), trial(-0.004, 0.002, 0.06)};
  EXPECT_THAT(table_text(table_of(trials)), AllOf(HasSubstr("paper, Table 1"), HasSubstr("RQE")));
  for (MonteCarloTrial& one : trials) one.rqe.reset();
  const Table table = table_of(trials, false);
  EXPECT_FALSE(table.rows[0].rqe);
  EXPECT_FALSE(table.rows[0].paper);
  EXPECT_THAT(table_text(table), Not(AnyOf(HasSubstr("paper"), HasSubstr("RQE"))));
  EXPECT_THAT(runs_csv(trials), HasSubstr("\n7,laser1.tau,m,0.003,0.004,,0.001,0.0015,\n"));
}

TEST(Table, WritesEveryRunAsALineAParameter) {
  MonteCarloTrial failed = trial(0.001, 0, 0);
  failed.refined = {.error = {}, .std_error = {}, .failure = "no walls"};
  const std::string csv = runs_csv({trial(-0.002, 0.001, 0), failed});
  EXPECT_THAT(csv, HasSubstr("seed,parameter,unit,bound,bound_with_steps,rqe_error,error,std_error,failure\n"
                             "7,laser1.tau,m,0.003,0.004,-0.002,0.001,0.0015,\n"));
  EXPECT_THAT(csv, HasSubstr("7,laser1.tau,m,0.003,0.004,0.001,,,\"no walls\"\n"));
}

TEST(Table, WithoutAnEstimateHasNoFigures) {
  MonteCarloTrial failed = trial(0.3, 0, 0);
  failed.refined = {.error = {}, .std_error = {}, .failure = "no walls"};
  const Table table = table_of({failed, trial(0.3, 0.3, 0)});
  EXPECT_FALSE(reports_refinement(table));
  EXPECT_EQ(table.rows[0].refined.estimates, 0U);
  const std::string text = table_text(table);
  EXPECT_THAT(text, HasSubstr("none"));
  EXPECT_THAT(text, Not(AnyOf(HasSubstr("0.000 ± 0.000"), HasSubstr("0.0  0.0 %"))));
  EXPECT_TRUE(reports_refinement(table_of({failed, trial(0, 0.001, 0)})));
}

TEST(Table, LeavesCellsEmptyWhereThereIsNoNumber) {
  MonteCarloTrial one = trial(0, 0.001, 0);
  one.bound[0] = one.refined.std_error[0] = std::numeric_limits<double>::infinity();
  one.bound_with_steps[0] = std::nan("");
  one.rqe->error.resize(0);
  EXPECT_THAT(runs_csv({one}), HasSubstr("\n7,laser1.tau,m,,,,0.001,,\n"));
  EXPECT_THAT(table_text(table_of({one})), Not(AnyOf(HasSubstr("inf"), HasSubstr("nan"))));
}

TEST(Table, OfNoRunsIsEmpty) { EXPECT_TRUE(table_of({}).rows.empty()); }

}  // namespace
}  // namespace crisp
