// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/relative_noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "pipeline/estimate/flat_surfaces.hpp"
#include "pipeline/estimate/incidence.hpp"
#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/estimate/surfel_jacobian.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::quality;
using namespace crisp::simulate;

/// The second laser is twice as noisy, the third one's noise grows with range and incidence.
ScannerSettings unequal(std::uint64_t seed, double duration) {
  ScannerSettings scanner = misplaced_scanner(seed, duration);
  scanner.laser_effects.resize(3);
  scanner.laser_effects[1].noise.sigma = 0.024;
  scanner.laser_effects[2].noise = {.slope = 0.003, .spread = 0.010};
  return scanner;
}

struct Reported {
  explicit Reported(const ScannerSettings& scanner)
      : recording(simulate_measurements(scanner, office())), sample(sample_of(recording)) {
    const PlacedBeams placed(SensorModel(recording.truth), sample);
    surfels = patches({}, 1)->update(placed.view(), true);
    sample.beams.cos_incidence = incidences(surfels, placed.view());
    noise = relative_noise(surfels, placed.view(), sample.beams, {});
  }

  SimulatedMeasurements recording;
  Sample sample;
  Surfels surfels;
  std::vector<float> noise;
};

/// [m] True standard deviation of a range in unequal().
double truth_of(const Measurements& beams, std::size_t i) {
  if (beams.laser[i] < 2) return beams.laser[i] == 1 ? 0.024 : 0.012;
  const double cosine = std::max(0.05, double{beams.cos_incidence[i]});
  const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
  return std::hypot(0.012, 0.003 * beams.range[i], 0.010 * tangent);
}

TEST(RelativeNoise, OfEqualLasersIsEmpty) {
  for (const std::uint64_t seed : {1, 2}) EXPECT_TRUE(Reported(misplaced_scanner(seed, 3)).noise.empty());
}

TEST(RelativeNoise, GoesByLaserRangeAndIncidence) {
  const Reported reported(unequal(1, 4));
  ASSERT_EQ(reported.noise.size(), reported.sample.beams.size());
  double inverse = 0;
  double off = 0;
  double common = 0;
  for (const std::uint32_t i : reported.surfels.members) {
    inverse += 1 / std::pow(double{reported.noise[i]}, 2);
    common += std::log(reported.noise[i] / truth_of(reported.sample.beams, i));
  }
  const auto count = static_cast<double>(reported.surfels.members.size());
  EXPECT_NEAR(inverse / count, 1, 0.03) << "but for beams that do not count";
  for (const std::uint32_t i : reported.surfels.members)
    off += std::pow(std::log(reported.noise[i] / truth_of(reported.sample.beams, i)) - common / count, 2);
  EXPECT_LT(std::sqrt(off / count), 0.12) << "in steps of a twelfth of the beams";
}

TEST(RelativeNoise, WeightsDoNotDependOnARangesOwnNoise) {
  // Or else what came out longer would weigh less, and every wall would be nearer than it is.
  ScannerSettings noisy = misplaced_scanner(2, 4);
  ScannerSettings exact = noisy;
  noisy.laser_effects.resize(3);
  noisy.laser_effects[2].noise.slope = 0.01;
  exact.range.sigma = 1e-9;
  const Reported reported(noisy);
  const auto without = simulate_measurements(exact, office());
  ASSERT_EQ(without.beams.size(), reported.noise.size());
  double longer = 0;
  double scatter = 0;
  for (std::size_t m = 0; m < reported.surfels.members.size(); ++m) {
    const std::uint32_t i = reported.surfels.members[m];
    if (reported.sample.beams.laser[i] != 2) continue;
    const double pull = (double{reported.recording.beams.range[i]} - double{without.beams.range[i]}) /
                        std::pow(double{reported.noise[i]}, 2);
    longer += pull;
    scatter += pull * pull;
  }
  EXPECT_LT(std::abs(longer), 4 * std::sqrt(scatter));
}

TEST(RelativeNoise, MakesEstimatesSurer) {
  const Reported reported(unequal(3, 4));
  const SensorModel model(reported.recording.truth);
  Division some(reported.sample.beams.size());
  for (std::size_t i = 0; i < some.size(); ++i) some[i] = static_cast<std::uint32_t>(i % 2000);
  // Standard errors by the empirical scatter of the block_scores of some beams, whatever the noise model.
  const auto errors_with = [&](const std::vector<float>& noise) {
    const PlacedBeams placed(model, reported.sample);
    Surfels surfels = reported.surfels;
    refine_all(surfels, placed.view(noise), {});
    const auto equations = normal_equations(surfels, placed.view(noise), all_free().size(),
                                            surfel_rows(model, reported.sample, all_free()), {}, {&some, 1});
    const double factor = equations.weight / equations.stiffness;
    return Eigen::VectorXd(factor *
                           (equations.matrix.inverse() * equations.block_scores[0]).rowwise().norm());
  };
  const Eigen::VectorXd ratio = errors_with(reported.noise).cwiseQuotient(errors_with({}));
  EXPECT_LT(ratio.head<3>().maxCoeff(), 0.95) << "the quiet laser's";
  EXPECT_LT(ratio.maxCoeff(), 1.05) << "the noisy one's own noise is no less for it";
}

TEST(RelativeNoise, LeavesARefinementHonest) {
  double chi2 = 0;
  constexpr std::uint64_t kSeeds = 4;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto recording = simulate_measurements(unequal(seed, 4), office());
    const SensorModel truth(recording.truth);
    const Refinement refined = refine_by_surfels(truth, sample_of(recording), {});
    EXPECT_TRUE(refined.converged);
    const auto& free = refined.outcome.free;
    const Eigen::VectorXd error = picked(refined.outcome.model, free) - picked(truth, free);
    chi2 += error.dot(refined.outcome.covariance.inverse() * error);
  }
  // χ² with 44 degrees of freedom is below 89 in all but one case of 15 000.
  EXPECT_LT(chi2, 89);
}

}  // namespace
}  // namespace crisp
