// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/pipeline/model/support.hpp"

namespace crisp {
namespace {

Measurements random_beams(std::size_t n) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> range(0.5F, 20), angle(-1.57F, 3.14F);
  Measurements beams;
  for (std::size_t i = 0; i < n; ++i) {
    Measurements beam = one_beam(range(random), angle(random));
    beam.time[0] = 0.3 + 1.4 * static_cast<double>(i) / static_cast<double>(n);
    beam.laser[0] = (i / 7) % 2;
    beams.append(beam);
  }
  return beams;
}

PlateTrajectory wavy_plate() {
  std::vector<double> times, angles;
  for (int i = 0; i <= 1000; ++i) {
    times.push_back(i * 0.002);
    angles.push_back(6 * times.back() + std::sin(3 * times.back()));
  }
  return {0, times, angles, 0.01};
}

TEST(PointDerivatives, AgreeWithFiniteDifferencesForEveryParameter) {
  const SensorModel model(two_lasers());
  const auto beams = random_beams(200);
  const auto plate = wavy_plate();
  const std::vector<std::size_t> free = {0, 1, 2, 3, 4, 5, 6, 7};
  PointDerivatives derivatives;
  const auto placed = model.place(beams, plate, free, derivatives);
  ASSERT_EQ(placed.index.size(), beams.size());
  ASSERT_EQ(derivatives.stride, 4U);

  for (std::size_t f = 0; f < free.size(); ++f) {
    constexpr double kStep = 1e-6;
    SensorModel up = model, down = model;
    Eigen::VectorXd values = model.values();
    values[static_cast<Eigen::Index>(f)] += kStep;
    up.set_values(values);
    values[static_cast<Eigen::Index>(f)] -= 2 * kStep;
    down.set_values(values);
    const Eigen::Matrix3Xd difference =
        (up.place(beams, plate).points - down.place(beams, plate).points) / (2 * kStep);
    for (std::size_t i = 0; i < beams.size(); ++i) {
      Eigen::Vector3d derivative = Eigen::Vector3d::Zero();
      const auto& columns = derivatives.columns[beams.laser[i]];
      for (std::size_t k = 0; k < columns.size(); ++k) {
        if (columns[k] == f)
          derivative = derivatives.values.col(static_cast<Eigen::Index>(i * derivatives.stride + k));
      }
      // Curvature: at 20 m and 6 rad/s a second difference is below 1e3 · step².
      EXPECT_NEAR((derivative - difference.col(static_cast<Eigen::Index>(i))).norm(), 0,
                  1e-6 * (1 + derivative.norm()))
          << model.names()[f] << " of beam " << i;
    }
  }
}

TEST(PointDerivatives, PlaceTheSamePointsAsWithout) {
  const SensorModel model(two_lasers());
  const auto beams = random_beams(300);
  const auto plate = wavy_plate();
  PointDerivatives derivatives;
  const auto with = model.place(beams, plate, {2, 5}, derivatives);
  const auto without = model.place(beams, plate);
  EXPECT_EQ(with.index, without.index);
  EXPECT_LT((with.points - without.points).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(derivatives.columns, (std::vector<std::vector<std::size_t>>{{0}, {1}}));
}

TEST(PointDerivatives, OfNoFreeParametersAreEmpty) {
  PointDerivatives derivatives;
  const auto placed = SensorModel(two_lasers()).place(random_beams(10), wavy_plate(), {}, derivatives);
  EXPECT_EQ(placed.index.size(), 10U);
  EXPECT_EQ(derivatives.values.cols(), 0);
}

}  // namespace
}  // namespace crisp
