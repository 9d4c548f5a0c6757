// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/angle_shift_regression.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <random>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;

/// Shifts of one laser on a plate that speeds up: passes of the last third are faster than those before, and
/// the encoder slips by `slip` at 7 s, in the way in which a lag of 0.1 s would show.
std::vector<AngleShift> of_a_faster_plate(double slip, std::size_t count) {
  std::mt19937_64 random(3);
  std::normal_distribution<> error(0, 0.3 * kDegree);
  std::vector<AngleShift> shifts;
  for (std::size_t i = 0; i < count; ++i) {
    const double later = 3.5 + 5.0 * static_cast<double>(i) / static_cast<double>(count);
    const double earlier = later - 3.4;
    const double faster = later < 5 ? -0.2 : later < 7 ? 0.8 : 1.3;  // [rad/s]
    shifts.push_back({.earlier = earlier,
                      .later = later,
                      .rate_earlier = 1.5,
                      .rate_later = 1.5 + faster + 0.1 * std::sin(5 * later),
                      .shift = (later > 7 ? slip : 0) + error(random)});
  }
  return shifts;
}

double weighted_squares(const Eigen::MatrixXd& rows, const Eigen::VectorXd& values,
                        const Eigen::VectorXd& weights) {
  const Eigen::VectorXd roots = weights.cwiseSqrt();
  const Eigen::MatrixXd a = roots.asDiagonal() * rows;
  const Eigen::VectorXd b = roots.cwiseProduct(values);
  return (b - a * a.completeOrthogonalDecomposition().solve(b)).squaredNorm();
}

TEST(AngleShiftModel, ScoresAStepByWhatItGainsWithTheRestRefitted) {
  const auto shifts = of_a_faster_plate(0.5 * kDegree, 150);
  const AngleShiftModel model(shifts, {});
  const auto n = static_cast<Eigen::Index>(shifts.size());
  Eigen::MatrixXd rows(n, 4);  // lag, square of the rate, backlash, step
  Eigen::VectorXd values(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const AngleShift& shift = shifts[static_cast<std::size_t>(i)];
    rows.row(i) << shift.rate_later - shift.rate_earlier,
        shift.rate_later * shift.rate_later - shift.rate_earlier * shift.rate_earlier, 0, 0;
    values[i] = shift.shift;
  }
  const double without = weighted_squares(rows, values, model.weights());
  const auto scores = model.step_scores();
  ASSERT_GT(scores.size(), 30U);
  for (const auto& score : scores) {
    const double time = AngleShiftModel::kBlock * static_cast<double>(score.block);
    for (Eigen::Index i = 0; i < n; ++i) {
      const AngleShift& shift = shifts[static_cast<std::size_t>(i)];
      const bool is_across = AngleShiftModel::block_of(shift.earlier) < score.block &&
                             score.block <= AngleShiftModel::block_of(shift.later);
      rows(i, 3) = is_across ? 1 : 0;
    }
    const double gain = without - weighted_squares(rows, values, model.weights());
    EXPECT_NEAR(score.gain, gain, 1e-6 * without) << time;
  }
}

TEST(AngleShiftModel, DistinguishesASlipFromALagWhereThePlateSpeedsUp) {
  const auto shifts = of_a_faster_plate(9.7 * kDegree, 180);
  AngleShiftModel model(shifts, {});
  const auto scores = model.step_scores();
  const auto best = std::ranges::max_element(scores, {}, &AngleShiftModel::StepScore::gain);
  ASSERT_NE(best, scores.end());
  model.add(AngleShiftModel::kBlock * static_cast<double>(best->block));
  EXPECT_NEAR(AngleShiftModel::kBlock * static_cast<double>(best->block), 7, 0.15);
  EXPECT_NEAR(model.size(0), 9.7 * kDegree, 4 * model.std_error(0) + 0.1 * kDegree);
}

}  // namespace
}  // namespace crisp
