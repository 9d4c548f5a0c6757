// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/shared_errors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::quality;
using namespace crisp::simulate;

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

TEST(QuantizationBlocks, LastUntilThePlateHasTurnedByAStep) {
  Measurements beams = scans_of({1});  // 20 ms apart
  const double duration = beams.time.back();
  std::vector<double> times;
  std::vector<double> angles;
  for (double t = -0.1; t < duration + 0.1; t += 0.01) {  // turns, stands, creeps
    times.push_back(t);
    angles.push_back(t < duration / 3 ? t : duration / 3 + std::max(0.0, 0.004 * (t - 2 * duration / 3)));
  }
  const PlateTrajectory plate(0, times, angles, 1);
  const Sample sample{.beams = beams, .plate = &plate};
  const Division pieces_of_beams = recording_blocks(beams);
  EXPECT_EQ(quantization_blocks(sample, 0), pieces_of_beams);
  constexpr double kStep = 0.004;
  const Division blocks = quantization_blocks(sample, kStep);
  std::map<std::uint32_t, std::set<std::uint32_t>> merged;
  for (std::size_t i = 0; i < blocks.size(); ++i) merged[blocks[i]].insert(pieces_of_beams[i]);
  std::size_t single = 0;
  std::size_t longest = 0;
  for (const auto& [block, pieces] : merged) {
    single += pieces.size() == 1 ? 1 : 0;
    longest = std::max(longest, pieces.size());
  }
  const std::size_t all = std::ranges::max(pieces_of_beams) + std::size_t{1};
  EXPECT_NEAR(static_cast<double>(single), static_cast<double>(all) / 3, 2);
  EXPECT_GT(longest, all / 3) << "the standstill is one block";
  EXPECT_NEAR(static_cast<double>(merged.size() - single), 1 + duration / 3, 2) << "a step a second";
}

TEST(PlaceBlocks, AreOfPlacesOnSurfacesWhateverTheNoise) {
  // A wall at z = 2, met from above by beams that are a little off along their way.
  Vectors points;
  Vectors directions;
  Surfels surfels;
  surfels.surfels.push_back({.middle = {0, 0, 2}, .normal = {0, 0, -1}, .u = {1, 0, 0}, .v = {0, 1, 0}});
  surfels.surfels.front().radius = 1;
  for (const double noise : {-0.1, 0.1}) {
    for (const double x : {-0.9, -0.6, -0.4, 0.1, 0.4, 0.6, 3.0}) {
      const Eigen::Vector3d direction = Eigen::Vector3d(x, 0, 2).normalized();
      const Eigen::Vector3d point = Eigen::Vector3d(x, 0.2, 2) + noise * direction;
      surfels.members.push_back(static_cast<std::uint32_t>(points.size()));
      points.x.push_back(point.x());
      points.y.push_back(point.y());
      points.z.push_back(point.z());
      directions.x.push_back(direction.x());
      directions.y.push_back(direction.y());
      directions.z.push_back(direction.z());
    }
  }
  surfels.surfels.front().end = static_cast<std::uint32_t>(points.size());
  const Division blocks = place_blocks(surfels, {points.view(), directions.view(), {}});
  EXPECT_THAT(blocks, testing::ElementsAre(2, 2, 6, 10, 10, 14, 14, 2, 2, 6, 10, 10, 14, 14));
}

TEST(Widened, MakesNoCombinationBetterKnown) {
  const Eigen::Matrix2d covariance{{1, 0.99}, {0.99, 1}};
  const Eigen::Vector2d by(3, 1);
  const Eigen::MatrixXd wider = widened(covariance, by);
  EXPECT_NEAR(wider(0, 0), 9, 1e-12);
  EXPECT_NEAR(wider(1, 1), 1, 1e-12);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> more(wider - covariance);
  EXPECT_GE(more.eigenvalues().minCoeff(), -1e-12);
}

TEST(WideningWithPrior, LeavesWhatThePriorKnows) {
  const Eigen::Vector3d by(5, 5, 5);
  // Known from the data, from both alike, and from the prior alone.
  const Eigen::VectorXd wider = widening_with_prior(by, Eigen::Vector3d(1e-9, 0.5, 1));
  EXPECT_NEAR(wider[0], 5, 1e-6);
  EXPECT_NEAR(wider[1] * wider[1], 1 / (0.5 / 25 + 0.5), 1e-12);
  EXPECT_NEAR(wider[2], 1, 1e-12);
}

using Change = std::function<void(ScannerSettings&)>;
using Spoil = std::function<void(SimulatedMeasurements&)>;

/// Errors of some kinds of parameters in standard errors, squared and summed up over four recordings.
double squares_of(const std::set<std::string>& kinds, double duration, const Change& change,
                  const Spoil& spoil) {
  double squares = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    auto scanner = misplaced_scanner(seed, duration);
    change(scanner);
    auto recording = simulate_measurements(scanner, office());
    spoil(recording);
    const SensorModel truth(recording.truth);
    const Refinement refined = refine_by_surfels(truth, sample_of(recording), {});
    const auto& free = refined.outcome.free;
    const Eigen::VectorXd error = picked(refined.outcome.model, free) - picked(truth, free);
    for (std::size_t k = 0; k < free.size(); ++k) {
      const auto slot = static_cast<Eigen::Index>(k);
      const std::string& name = truth.names()[free[k]];
      if (!kinds.contains(name.substr(name.find('.') + 1))) continue;
      squares += error[slot] * error[slot] / refined.outcome.covariance(slot, slot);
    }
  }
  return squares;
}

TEST(SharedErrors, OfDirectionsOfAMirrorAreInTheStandardErrors) {
  // Ranges like a real LMS1xx's: two peaks, the weight of which each direction of the mirror has for good.
  const auto two_peaks = [](ScannerSettings& scanner) {
    const LaserEffects noise{.noise = {.sigma = 0.005, .separation = 0.015}};
    scanner.laser_effects.assign(scanner.truth.lasers.size(), noise);
  };
  // Two λ and three α of each recording. Were all twenty independent, their squares would sum up to 20 ± 6.3;
  // they are correlated in pairs at worst. Without the blocks of scans it is thirty times as much.
  EXPECT_LT(squares_of({"lambda", "alpha"}, 2, two_peaks, [](SimulatedMeasurements&) {}),
            20 + 4 * 6.3 * std::numbers::sqrt2);
}

TEST(SharedErrors, OfSurfacesThatAreNoPlanesAreInTheStandardErrors) {
  // Waves in each direction, the same at every turn.
  const auto waves = [](SimulatedMeasurements& recording) {
    constexpr double kHigh = 0.015;                        // [m]
    constexpr double kWaves = 2 * std::numbers::pi / 1.5;  // [rad/m]
    const PlacedBeams placed(SensorModel(recording.truth), sample_of(recording));
    const PointsView at = placed.view().points;
    for (std::size_t i = 0; i < recording.beams.size(); ++i) {
      recording.beams.range[i] += static_cast<float>(
          kHigh * (std::sin(kWaves * at.x[i]) + std::sin(kWaves * at.y[i]) + std::sin(kWaves * at.z[i])));
    }
  };
  // Twelve τ: 12 ± 4.9. Without the blocks of places it is 31.
  EXPECT_LT(squares_of(
                {"tau"}, 6, [](ScannerSettings&) {}, waves),
            12 + 3 * 4.9);
}

}  // namespace
}  // namespace crisp
