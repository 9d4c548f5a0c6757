// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include <crisp/error.hpp>

#include "grabbers/simulate/shapes.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::simulate;

constexpr double kNoise = 0.012;  // [m]
const Eigen::Vector3d kLow(-3, -2, -1);
const Eigen::Vector3d kHigh(4, 2.5, 1.8);

/// Beams without noise in a room of six planes, and which of them each meets.
struct RoomBeams {
  SimulatedMeasurements simulated;
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> offsets;  // normal · x
  std::vector<std::uint32_t> surface;

  Sample sample() const { return {.beams = simulated.beams, .plate = &simulated.plate}; }
};

RoomBeams room_beams() {
  ScannerSettings scanner = misplaced_scanner(1, 3.0);
  scanner.beams = {10, 130, 230, 370, 490};
  scanner.range = {.sigma = 0, .quantum = 0};
  scanner.encoder_quantised = false;
  RoomBeams room{.simulated = simulate_measurements(scanner, {"box", box("box", kLow, kHigh, 0.5)})};
  for (int axis = 0; axis < 3; ++axis) {
    for (const Eigen::Vector3d& corner : {kLow, kHigh}) {
      room.normals.emplace_back(Eigen::Vector3d::Unit(axis));
      room.offsets.push_back(corner[axis]);
    }
  }
  const auto placed = SensorModel(room.simulated.truth).place(room.simulated.beams, room.simulated.plate);
  for (Eigen::Index i = 0; i < placed.points.cols(); ++i) {
    std::uint32_t best = 0;
    const auto miss = [&](std::uint32_t s) {
      return std::abs(room.normals[s].dot(placed.points.col(i)) - room.offsets[s]);
    };
    for (std::uint32_t s = 1; s < 6; ++s) best = miss(s) < miss(best) ? s : best;
    room.surface.push_back(best);
  }
  return room;
}

/// The ranges that a model predicts for given planes: from where each beam starts and where it goes.
Eigen::VectorXd ranges(const RoomBeams& room, const SensorModel& model,
                       const std::vector<Eigen::Vector4d>& planes) {
  Measurements at = room.simulated.beams;
  at.range.assign(at.size(), 1);
  const auto one = model.place(at, room.simulated.plate).points;
  at.range.assign(at.size(), 2);
  const auto two = model.place(at, room.simulated.plate).points;
  Eigen::VectorXd result(one.cols());
  for (Eigen::Index i = 0; i < one.cols(); ++i) {
    const Eigen::Vector4d& plane = planes[room.surface[static_cast<std::size_t>(i)]];
    const Eigen::Vector3d direction = two.col(i) - one.col(i);
    const Eigen::Vector3d origin = one.col(i) - direction;
    result[i] = (plane[3] - plane.head<3>().dot(origin)) / plane.head<3>().dot(direction);
  }
  return result;
}

/// The derivatives of all ranges by the free parameters and by every plane's slopes and offset, by
/// differences.
Eigen::MatrixXd jacobian(const RoomBeams& room, const std::vector<std::size_t>& free) {
  const SensorModel truth(room.simulated.truth);
  std::vector<Eigen::Vector4d> planes;
  for (std::size_t s = 0; s < 6; ++s) {
    planes.emplace_back(room.normals[s].x(), room.normals[s].y(), room.normals[s].z(), room.offsets[s]);
  }
  constexpr double kStep = 1e-4;
  Eigen::MatrixXd result(static_cast<Eigen::Index>(room.surface.size()),
                         static_cast<Eigen::Index>(free.size()) + 18);
  Eigen::Index column = 0;
  for (const std::size_t parameter : free) {
    SensorModel up = truth;
    SensorModel down = truth;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(truth.values().size());
    step[static_cast<Eigen::Index>(parameter)] = kStep;
    up.set_values(truth.values() + step);
    down.set_values(truth.values() - step);
    result.col(column++) = (ranges(room, up, planes) - ranges(room, down, planes)) / (2 * kStep);
  }
  for (std::size_t s = 0; s < 6; ++s) {
    for (int part = 0; part < 4; ++part) {
      if (part == static_cast<int>(s) / 2) continue;  // the normal's length is no unknown
      auto up = planes;
      auto down = planes;
      up[s][part] += kStep;
      down[s][part] -= kStep;
      result.col(column++) = (ranges(room, truth, up) - ranges(room, truth, down)) / (2 * kStep);
    }
  }
  return result;
}

TEST(Bound, IsThatOfOneGreatProblemWithAllPlanesUnknown) {
  const RoomBeams room = room_beams();
  const SensorModel truth(room.simulated.truth);
  const Eigen::MatrixXd dense = jacobian(room, all_free()) / kNoise;
  const Eigen::MatrixXd covariance = (dense.transpose() * dense).inverse().topLeftCorner(11, 11);
  const Eigen::MatrixXd information =
      calibration_information(truth, room.sample(), room.surface, room.normals, all_free(), {kNoise});
  // Ranges are stored as floats: a part in 10⁷; differences are good to 10⁻⁸ / step².
  EXPECT_LT((information.inverse() - covariance).norm(), 1e-4 * covariance.norm());
  const Eigen::VectorXd least = least_std_errors(information);
  for (Eigen::Index k = 0; k < 11; ++k) EXPECT_NEAR(least[k] / std::sqrt(covariance(k, k)), 1, 1e-4) << k;
}

TEST(Bound, GrowsWithTheNoise) {
  const RoomBeams room = room_beams();
  const SensorModel truth(room.simulated.truth);
  const auto bound = [&](double noise) {
    return least_std_errors(
        calibration_information(truth, room.sample(), room.surface, room.normals, all_free(), {noise}));
  };
  EXPECT_LT((bound(2 * kNoise) - 2 * bound(kNoise)).norm(), 1e-4 * bound(kNoise).norm());
}

TEST(Bound, GrowsWithTheStepsOfTheEncoder) {
  const RoomBeams room = room_beams();
  const SensorModel truth(room.simulated.truth);
  const auto bound = [&](double step) {
    return least_std_errors(calibration_information(truth, room.sample(), room.surface, room.normals,
                                                    all_free(), {.range = kNoise, .encoder_step = step}));
  };
  const Eigen::VectorXd exact = bound(0);
  EXPECT_LT((bound(1e-12) - exact).norm(), 1e-6 * exact.norm());
  const Eigen::VectorXd coarse = bound(0.1);
  EXPECT_GT((coarse.array() / exact.array()).minCoeff(), 1);
  for (const Eigen::Index eta : {2, 6, 10}) EXPECT_GT(coarse[eta], 1.2 * exact[eta]);
}

TEST(Bound, OfAnUnidentifiableParameterIsInfinite) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information(0, 0) = 4;
  information.bottomRightCorner<2, 2>() << 1e6, 1e6, 1e6, 1e6;  // only the sum of two is known
  const Eigen::VectorXd least = least_std_errors(information);
  EXPECT_DOUBLE_EQ(least[0], 0.5);
  EXPECT_EQ(least[1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(least[2], std::numeric_limits<double>::infinity());
}

TEST(Bound, RefusesBeamsWithoutASurface) {
  const RoomBeams room = room_beams();
  const SensorModel truth(room.simulated.truth);
  EXPECT_THROW(calibration_information(truth, room.sample(), {}, room.normals, all_free(), {kNoise}), Error);
  EXPECT_THROW(calibration_information(truth, room.sample(), room.surface, {}, all_free(), {kNoise}), Error);
  EXPECT_THROW(calibration_information(truth, room.sample(), room.surface, room.normals, all_free(), {0}),
               Error);
}

}  // namespace
}  // namespace crisp
