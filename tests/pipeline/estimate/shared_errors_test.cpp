// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/shared_errors.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <set>
#include <string>

#include "pipeline/estimate/surfel_refinement.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

/// Two seconds of scans of one laser after the other, each of so many beams.
Measurements scans_of(const std::vector<std::uint16_t>& beams) {
  Measurements all;
  for (int scan = 0; scan < 100; ++scan) {
    for (std::size_t laser = 0; laser < beams.size(); ++laser) {
      for (std::uint16_t beam = 0; beam < beams[laser]; ++beam) {
        all.range.push_back(1);
        all.mirror_angle.push_back(0);
        all.time.push_back(0.02 * scan + 1e-5 * beam);
        all.laser.push_back(static_cast<std::uint16_t>(laser));
        all.remission.push_back(0);
        all.beam.push_back(beam);
      }
    }
  }
  return all;
}

TEST(ScanBlocks, AreHundredthsOfALasersScan) {
  const Measurements beams = scans_of({541, 271});
  const Division blocks = scan_blocks(beams);
  std::set<std::uint32_t> different(blocks.begin(), blocks.end());
  EXPECT_EQ(different.size(), 200U);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    EXPECT_EQ(blocks[i], 100U * beams.laser[i] + 100U * beams.beam[i] / (beams.laser[i] == 0 ? 541U : 271U));
  }
}

TEST(ScanBlocks, ArePiecesOfTheRecordingForALaserOfFewDirections) {
  const Measurements beams = scans_of({1, 541});
  const Division blocks = scan_blocks(beams);
  const Division pieces = recording_blocks(beams);
  std::set<std::uint32_t> of_one;
  std::set<std::uint32_t> of_many;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    (beams.laser[i] == 0 ? of_one : of_many).insert(blocks[i]);
    if (beams.laser[i] == 0) {
      EXPECT_EQ(blocks[i], pieces[i]);
    }
  }
  EXPECT_GE(of_one.size(), 100U);
  EXPECT_EQ(of_many.size(), 100U);
  EXPECT_GT(*of_many.begin(), *of_one.rbegin());
}

/// Errors of λ and α in standard errors, squared, with ranges like a real LMS1xx's: two peaks, the weight of
/// which each direction of the mirror has for good.
double squares_with_two_peaks(std::uint64_t seed) {
  auto scanner = misplaced_scanner(seed, 2.0);
  const LaserEffects two_peaks{.noise = {.sigma = 0.005, .separation = 0.015}};
  scanner.laser_effects.assign(scanner.truth.lasers.size(), two_peaks);
  const auto recording = simulate_measurements(scanner, office());
  const SensorModel truth(recording.truth);
  const Refinement refined = refine_by_surfels(truth, sample_of(recording), {});
  const auto& free = refined.outcome.free;
  const Eigen::VectorXd error = picked(refined.outcome.model, free) - picked(truth, free);
  double squares = 0;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto slot = static_cast<Eigen::Index>(k);
    const std::string name = truth.names()[free[k]];
    if (!name.ends_with(".lambda") && !name.ends_with(".alpha")) continue;
    squares += error[slot] * error[slot] / refined.outcome.covariance(slot, slot);
  }
  return squares;
}

TEST(SharedErrors, OfDirectionsOfAMirrorAreInTheStandardErrors) {
  // Of each recording two λ and three α. Were all twenty independent, their squares would sum up to 20 ± 6.3;
  // they are correlated in pairs at worst. Without the blocks of scans it is thirty times as much.
  double squares = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) squares += squares_with_two_peaks(seed);
  EXPECT_LT(squares, 20 + 4 * 6.3 * std::sqrt(2));
}

}  // namespace
}  // namespace crisp
