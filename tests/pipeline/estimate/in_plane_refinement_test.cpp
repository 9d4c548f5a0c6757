// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <crisp/error.hpp>

#include "grabbers/simulate/paper.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::simulate;

SensorModel shifted(const SensorModel& model, double tau, double alpha, double eta) {
  SensorModel result = model;
  Eigen::VectorXd values = model.values();
  for (Eigen::Index laser = 0; laser < 3; ++laser) {
    values[4 * laser + 1] += tau;
    values[4 * laser + 2] -= alpha;
    values[4 * laser + 3] += eta;
  }
  result.set_values(values);
  return result;
}

TEST(InPlaneRefinement, FindsTheTruthWithinItsStandardErrors) {
  // Each squared error over its variance is 1 on average: a sum of n has a standard deviation of √(2 n), or
  // √3 times that, as λ and α of a laser go together.
  double sum = 0;
  double n = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto recording = simulate_measurements(paper_scanner(seed), paper_room());
    const SensorModel truth(recording.truth);
    const SensorModel start = shifted(truth, 0.005, 0.003, 0.001);
    const auto found = refine_by_surfels(start, sample_of(recording), {});
    EXPECT_TRUE(found.converged) << seed;
    EXPECT_EQ(found.surfels, 7U) << seed;  // the walls of the room
    EXPECT_GT(found.beams, 2950U) << "of about 3000";
    for (std::size_t k = 0; k < 11; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double error = found.outcome.model.values()[i + 1] - truth.values()[i + 1];
      sum += error * error / found.outcome.covariance(i, i);
      n += 1;
    }
  }
  EXPECT_NEAR(sum / n, 1, 4 * std::sqrt(3 * 2 / n));
}

TEST(InPlaneRefinement, LeavesOfTheDistancesWhatTheNoiseMakes) {
  const auto recording = simulate_measurements(paper_scanner(2), paper_room());
  RefinementSettings settings;
  settings.surfels.outlier = 0;  // all count in full, so that the squares are those of the noise
  const auto found = refine_by_surfels(SensorModel(recording.truth), sample_of(recording), settings);
  EXPECT_NEAR(found.chi2, 1, 4 * std::sqrt(2.0 / 3000));
}

TEST(InPlaneRefinement, EndsAtTheSameOptimumFromOtherStarts) {
  const auto recording = simulate_measurements(paper_scanner(5), paper_room());
  const SensorModel truth(recording.truth);
  const auto from = [&](double scale) {
    return refine_by_surfels(shifted(truth, 0.004 * scale, 0.002 * scale, 0.0005 * scale),
                             sample_of(recording), {});
  };
  const auto one = from(1);
  const auto other = from(-1);
  const Eigen::VectorXd errors = one.outcome.covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd apart =
      picked(one.outcome.model, all_free()) - picked(other.outcome.model, all_free());
  EXPECT_LT((apart.array() / errors.array()).abs().maxCoeff(), 0.3);  // some beams in corners change walls
}

TEST(InPlaneRefinement, ReportsThatAConstantSpeedConfoundsEtaWithLambda) {
  ScannerSettings scanner = paper_scanner(1);
  scanner.motion = {.kind = MotionKind::constant, .max_rate = 0.91};  // no whole number of scans a turn
  const auto recording = simulate_measurements(scanner, paper_room());
  const auto found = refine_by_surfels(SensorModel(recording.truth), sample_of(recording), {});
  std::vector<std::string> lost;
  for (const auto& each : found.outcome.unobservable) lost.push_back(each.parameter);
  EXPECT_THAT(lost, testing::UnorderedElementsAre("laser1.eta", "laser2.eta", "laser3.eta", "laser2.lambda",
                                                  "laser3.lambda"));
}

TEST(InPlaneRefinement, ReportsThatItSeesNoWalls) {
  ScannerSettings scanner = paper_scanner(1);
  scanner.duration = 0.1;  // 30 beams
  const auto recording = simulate_measurements(scanner, paper_room());
  EXPECT_THROW(refine_by_surfels(SensorModel(recording.truth), sample_of(recording), {}), Error);
}

}  // namespace
}  // namespace crisp
