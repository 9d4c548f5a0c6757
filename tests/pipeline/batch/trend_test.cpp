// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/trend.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <random>

namespace crisp {
namespace {

using namespace crisp::batch;
using testing::ElementsAre;
using testing::HasSubstr;

/// A trusted recording that begins at this time and has one parameter.
BatchRow row(int number, double value, double std_error, const std::string& unit = "m") {
  BatchRow row{.name = "r" + std::to_string(number), .status = "done"};
  row.begin = number;
  row.parameters["l.tau"] = {.value = value, .std_error = std_error, .unit = unit};
  return row;
}

/// Recordings that differ by their noise alone; errors between 1 and 3 mm.
std::vector<BatchRow> alike(unsigned seed, int count, double value = 0.2, const std::string& unit = "m") {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<BatchRow> rows;
  for (int i = 0; i < count; ++i) {
    const double error = 0.001 * (1 + i % 3);
    rows.push_back(row(i, value + error * normal(random), error, unit));
  }
  return rows;
}

std::size_t standing_out(std::vector<BatchRow> rows) {
  mark_outstanding(batch_trend(rows), rows);
  return static_cast<std::size_t>(
      std::ranges::count_if(rows, [](const BatchRow& each) { return !each.stands_out.empty(); }));
}

TEST(Trend, LeavesRecordingsThatDifferByTheirErrorsAlone) {
  std::size_t batches = 0;
  constexpr unsigned kBatches = 300;
  for (unsigned seed = 1; seed <= kBatches; ++seed) batches += standing_out(alike(seed, 30)) > 0 ? 1 : 0;
  // Three are expected of 300 at one per cent; twelve and more have a probability of 1e-4.
  EXPECT_LT(batches, 12U);
}

TEST(Trend, ShowsTheRecordingThatChangedByMoreThanItsErrorAllows) {
  auto rows = alike(1, 30);
  rows[7].parameters["l.tau"].value = 0.2 + 8 * *rows[7].parameters["l.tau"].std_error;
  const auto trends = batch_trend(rows);
  mark_outstanding(trends, rows);
  EXPECT_THAT(rows[7].stands_out, ElementsAre("l.tau"));
  EXPECT_EQ(standing_out(rows), 1U);
  EXPECT_NEAR(trends[0].centre, 0.2, 4 * trends[0].centre_error);
  EXPECT_EQ(trend_json(trends)[0]["stand_out"][0]["recording"], "r7");
}

TEST(Trend, ShowsTheFewerOfTwoGroupsWhereTheScannerWasChangedForGood) {
  auto rows = alike(1, 30);
  for (std::size_t i = 20; i < rows.size(); ++i) rows[i].parameters["l.tau"].value += 0.03;
  mark_outstanding(batch_trend(rows), rows);
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].stands_out.empty(), i < 20) << i;
}

TEST(Trend, TakesAnglesAcrossAWholeTurnForNear) {
  const double turn = 2 * std::numbers::pi;
  auto rows = alike(1, 30, turn - 0.001, "rad");
  for (auto& each : rows) {
    double& value = each.parameters["l.tau"].value;
    if (value > turn) value -= turn;
  }
  EXPECT_EQ(standing_out(rows), 0U);
}

TEST(Trend, LeavesOutWhatIsNotTrustedNotEstimatedOrFoundTooSeldom) {
  auto rows = alike(1, 4);
  rows[0].status = "untrusted";
  rows[0].parameters["l.tau"].value = 9;
  rows[1].parameters["l.lambda"] = {.value = 1, .std_error = std::nullopt, .unit = "rad"};
  const auto trends = batch_trend(rows);
  ASSERT_EQ(trends.size(), 1U);
  EXPECT_EQ(trends[0].points.size(), 3U);
  rows[1].status = "failed";
  EXPECT_TRUE(batch_trend(rows).empty());
}

TEST(Trend, OrdersRecordingsByTheirTimeAndDrawsThem) {
  auto rows = alike(1, 5);
  rows[0].begin = 100;
  const auto trends = batch_trend(rows);
  EXPECT_EQ(trends[0].points.front().recording, "r1");
  EXPECT_EQ(trends[0].points.back().recording, "r0");
  EXPECT_THAT(trend_svg(trends), HasSubstr("l.tau [mm]"));
}

/// The centre of values of equal error is their median, with the standard error of the median.
TEST(Trend, HasTheStandardErrorOfItsCentre) {
  constexpr int kBatches = 400;
  double squares = 0;
  double printed = 0;
  for (int seed = 1; seed <= kBatches; ++seed) {
    const auto trends = batch_trend(alike(static_cast<unsigned>(seed), 60));
    squares += (trends[0].centre - 0.2) * (trends[0].centre - 0.2);
    printed = trends[0].centre_error;
  }
  // A standard deviation of 400 values is known to 3.5 %; the median is not yet at its asymptotic error.
  EXPECT_NEAR(std::sqrt(squares / kBatches) / printed, 1, 0.15);
}

}  // namespace
}  // namespace crisp
