// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <crisp/revolutions.hpp>

namespace crisp {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kScan = 0.02;  // [s]
constexpr int kBeams = 10;

/// A trajectory of 5 s whose angle is a function of time, read 500 times a second.
template <class Angle>
PlateTrajectory turning(const Angle& angle) {
  std::vector<double> times, angles;
  for (int i = 0; i <= 2500; ++i) {
    times.push_back(0.002 * i);
    angles.push_back(angle(times.back()));
  }
  return {0, times, angles, 0.1};
}

/// A scan's points, the first at `begin`.
Cloud scan(std::uint16_t laser, double begin) {
  Cloud cloud;
  cloud.header.stamp = 1234;
  for (int k = 0; k < kBeams; ++k) {
    Point point;
    point.laser = laser;
    point.time = begin + k * kScan / kBeams;
    cloud.push_back(point);
  }
  return cloud;
}

/// What becomes of the scans of three lasers, each a third of a scan behind the other.
std::vector<std::shared_ptr<const Cloud>> gather(const RevolutionSettings& settings,
                                                 const PlateTrajectory& plate, double seconds) {
  std::vector<std::shared_ptr<const Cloud>> clouds;
  Revolutions revolutions(settings,
                          [&](std::shared_ptr<const Cloud> cloud) { clouds.push_back(std::move(cloud)); });
  const int scans = static_cast<int>(std::lround(seconds / kScan));
  for (int i = 0; i < scans; ++i) {
    for (std::uint16_t laser = 0; laser < 3; ++laser) {
      revolutions.add(scan(laser, i * kScan + laser * kScan / 3), plate);
    }
  }
  revolutions.finish();
  return clouds;
}

TEST(Revolutions, HoldEachPointOfATurnAndNoOther) {
  const auto plate = turning([](double t) { return kTurn * t + 0.3; });
  const auto clouds = gather({}, plate, 3.5);
  ASSERT_EQ(clouds.size(), 4U);
  std::size_t points = 0;
  for (std::size_t k = 0; k < clouds.size(); ++k) {
    EXPECT_EQ(clouds[k]->header.stamp, 1234U);
    points += clouds[k]->size();
    for (const Point& point : *clouds[k]) {
      EXPECT_GE(point.time, static_cast<double>(k) - 1e-9);
      EXPECT_LT(point.time, static_cast<double>(k) + 1 + 1e-9);
    }
  }
  EXPECT_EQ(points, 175U * 3 * kBeams) << "none is lost, none comes twice";
  EXPECT_EQ(clouds[1]->size(), 50U * 3 * kBeams);
}

TEST(Revolutions, MayBeHalfOnesAndBackwards) {
  const auto plate = turning([](double t) { return -kTurn * 2 * t; });
  const auto clouds = gather({.turns = 0.5}, plate, 1);
  ASSERT_EQ(clouds.size(), 5U) << "the last is the rest of the last scans";
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_NEAR(static_cast<double>(clouds[k]->size()), 0.25 / kScan * 3 * kBeams, 3);
  }
}

TEST(Revolutions, AreGivenWithTheFirstScanOfEachLaserBehindThem) {
  const auto plate = turning([](double t) { return kTurn * t; });
  double given_at = 0;
  double now = 0;
  Revolutions revolutions({}, [&](const auto&) { given_at = now; });
  for (int i = 0; i < 60 && given_at == 0; ++i) {
    for (std::uint16_t laser = 0; laser < 3; ++laser) {
      now = i * kScan + laser * kScan / 3;
      revolutions.add(scan(laser, now), plate);
    }
  }
  EXPECT_GT(given_at, 1 - kScan);
  EXPECT_LT(given_at, 1 + 2 * kScan);
}

TEST(Revolutions, DoNotWaitForALaserThatFellSilent) {
  const auto plate = turning([](double t) { return kTurn * t; });
  std::size_t clouds = 0;
  Revolutions revolutions({}, [&](const auto&) { ++clouds; });
  for (int i = 0; i < 60; ++i) {
    if (i < 30) revolutions.add(scan(0, i * kScan), plate);
    revolutions.add(scan(1, i * kScan), plate);
  }
  EXPECT_EQ(clouds, 1U);
}

TEST(Revolutions, EndAfterAWhileWhereThePlateSwaysOrStands) {
  const auto plate = turning([](double t) { return 2 * std::sin(kTurn * t); });
  const auto clouds = gather({.longest = 1.5}, plate, 4);
  ASSERT_EQ(clouds.size(), 3U);
  EXPECT_NEAR(clouds[1]->front().time, 1.5, kScan);
  const PlateTrajectory unknown;
  EXPECT_EQ(gather({.longest = 1.5}, unknown, 4).size(), 3U);
}

}  // namespace
}  // namespace crisp
