// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/paper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <crisp/sensor_model.hpp>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/ray_caster.hpp"

namespace crisp {
namespace {

using namespace crisp::simulate;

TEST(Paper, ItsBeamsLieInThePlatesPlaneAndGoRoundTheRoom) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto simulated = simulate_measurements(paper_scanner(seed), paper_room());
    EXPECT_EQ(simulated.no_echo, 0U) << "the room is closed in the plane";
    EXPECT_NEAR(static_cast<double>(simulated.beams.size()), 3 * 2 * 500, 3 * 2 * 5);
    for (const float angle : simulated.beams.mirror_angle) {
      ASSERT_NEAR(std::abs(angle), std::numbers::pi / 2, 1e-6);
    }
    const auto angles = simulated.plate.angles();
    const double revolutions = (angles.back() - angles.front()) / (2 * std::numbers::pi);
    EXPECT_NEAR(revolutions, 10, 5);  // ten draws of a rate between 0 and 2: a spread of 1.8
  }
}

TEST(Paper, ItsPointsAreAtTheWallsWithinTheNoise) {
  const auto simulated = simulate_measurements(paper_scanner(1), paper_room());
  const auto placed = SensorModel(simulated.truth).place(simulated.beams, simulated.plate);
  const RayCaster walls(paper_room());
  double sum = 0;
  for (Eigen::Index i = 0; i < placed.points.cols(); ++i) {
    sum += std::pow(walls.distance(placed.points.col(i)), 2);
  }
  const double rms = std::sqrt(sum / static_cast<double>(placed.points.cols()));
  // Oblique beams miss the wall by σ cos β; the encoder's steps add at most 0.011° · 5 m = 1 mm.
  EXPECT_LT(rms, 0.0125);
  EXPECT_GT(rms, 0.006);
}

}  // namespace
}  // namespace crisp
