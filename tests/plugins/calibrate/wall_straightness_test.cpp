// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/wall_straightness.hpp"

#include <gtest/gtest.h>

#include "pipeline/estimate/base_parameters.hpp"
#include "pipeline/estimate/parameter_prior.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using namespace crisp::estimate;
using namespace crisp::simulate;

constexpr double kHalfWidth = 0.0044;  // [rad]

/// Ten seconds in the hall by a plate that turns to and fro at up to 2 Hz: 25 scans a turn.
SimulatedMeasurements to_and_fro(std::uint64_t seed) {
  auto scanner = misplaced_scanner(seed, 10);
  scanner.motion.kind = MotionKind::reversal;
  return simulate_measurements(scanner, hall());
}

/// The front beams of one laser.
Sample front_of(const SimulatedMeasurements& recording, std::size_t laser) {
  const Sample inside = covered(sample_of(recording), -0.1, 0.1);
  return of_laser(in_plane(inside, kHalfWidth, Half::kFront), laser);
}

std::vector<double> within(double centre, double reach) {
  std::vector<double> grid;
  for (int i = -16; i <= 16; ++i) grid.push_back(centre + reach * i / 16);
  return grid;
}

TEST(WallStraightness, KnowsAPlateThatTurnsBothWays) {
  const auto reversal = to_and_fro(1);
  EXPECT_TRUE(turns_both_ways(front_of(reversal, 0)));
  const auto varying = simulate_measurements(misplaced_scanner(1, 3), hall());
  EXPECT_FALSE(turns_both_ways(front_of(varying, 0)));
}

TEST(WallStraightness, KnowsHowOftenALaserScans) {
  const auto recording = to_and_fro(1);
  EXPECT_NEAR(between_scans(front_of(recording, 0)), 0.02, 2e-4) << "LMS-151, mirrors 0.2 % off";
}

TEST(WallStraightness, IsLeastWhereTheTurnsOfThePlateAgree) {
  const auto recording = to_and_fro(2);
  const SensorModel truth(recording.truth);
  const Sample front = front_of(recording, 1);
  const std::size_t eta = slot(truth, 1, kEta);
  const double right = recording.truth.lasers[1].eta.value;
  const double least = wall_straightness(truth, front, 0.1);
  for (const double off : {-0.008, -0.003, 0.003, 0.008}) {
    EXPECT_GT(wall_straightness(with_one(truth, eta, right + off), front, 0.1), 1.2 * least) << off << " s";
  }
}

TEST(WallStraightness, DeterminesALagHoweverSpotsBunch) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto recording = to_and_fro(seed);
    SensorModel model(nominal_calibration(default_rig()));  // τ and α off by up to 2 cm and 3°
    for (std::size_t laser = 0; laser < 3; ++laser) {
      const std::size_t eta = slot(model, laser, kEta);
      const double right = recording.truth.lasers[laser].eta.value;
      model = with_one(model, eta, right + 0.005);  // where a kernel may have it
      const auto competitor = minimize_wall_residual(model, eta, within(right + 0.005, 0.01), false,
                                                     front_of(recording, laser), 0.1);
      EXPECT_NEAR(model.values()[static_cast<Eigen::Index>(eta)], right, 6e-4) << seed << ", " << laser;
      if (competitor) {
        EXPECT_GT(competitor->height, 0.1) << seed << ", " << laser;
      }
    }
  }
}

}  // namespace
}  // namespace crisp
