// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/measurements.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

#include "grabbers/simulate/ray_caster.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "grabbers/simulate/shapes.hpp"
#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::simulate;
using Eigen::AngleAxisd;
using Eigen::Vector3d;

Scene plain_room() { return {"room", box("room", {-3, -2, -1}, {5, 4, 2}, 0.5)}; }

ScannerSettings exact_settings() {
  ScannerSettings settings;
  settings.range = {.sigma = 0, .quantum = 0, .max_distance = 50};
  settings.duration = 1;
  return settings;
}

float range_at(const Measurements& beams, std::uint16_t laser, std::uint16_t beam) {
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams.laser[i] == laser && beams.beam[i] == beam) return beams.range[i];
  }
  return -1;
}

TEST(SimulateMeasurements, MeasuresHandWorkedRangesInABoxRoom) {
  // Stationary plate at φ = 30°, τ = 0.2 m. θ = 90° (reported 135°, beam 360) leaves tangentially from
  // (0.2 cos 30°, 0.2 sin 30°) along (−sin 30°, cos 30°) and meets y = 4 after (4 − 0.1)/cos 30°. θ = 0
  // (beam 180) points down to z = −1, θ = 180° (beam 540) up to z = 2; θ = −90° (beam 0) back to y = −2.
  const auto simulated =
      simulate_measurements(exact_settings(), plain_room(), Motion({{0, 0}}, 30 * kDegree));
  EXPECT_NEAR(range_at(simulated.beams, 0, 360), 3.9 / std::cos(30 * kDegree), 1e-6);
  EXPECT_NEAR(range_at(simulated.beams, 0, 180), 1, 1e-6);
  EXPECT_NEAR(range_at(simulated.beams, 0, 540), 2, 1e-6);
  EXPECT_NEAR(range_at(simulated.beams, 0, 0), 2.1 / std::cos(30 * kDegree), 1e-6);
  // Laser 2 sits at φ + λ = 150°, at y = 0.2 sin 150° = 0.1; its beam 360 leaves along (−sin 150°, cos 150°)
  // and meets y = −2 first.
  EXPECT_NEAR(range_at(simulated.beams, 1, 360), 2.1 / std::cos(30 * kDegree), 1e-6);
}

/// Equation (2) of the paper, written with rotation matrices: independent of the model's own code.
Vector3d equation_two(const LaserCalibration& laser, double phi, double theta, double range) {
  const Vector3d beam(range * std::cos(theta), range * std::sin(theta), 0);
  const Vector3d mounted =
      AngleAxisd(laser.alpha.value, Vector3d::UnitZ()) * (AngleAxisd(90 * kDegree, Vector3d::UnitY()) * beam);
  return AngleAxisd(phi + laser.lambda.value, Vector3d::UnitZ()) *
         (mounted + Vector3d(laser.tau.value, 0, 0));
}

TEST(SimulateMeasurements, PutsEveryBeamOnAWallByEquationsTwoAndThree) {
  ScannerSettings settings = exact_settings();
  settings.truth.lasers[0].eta.value = -0.031;
  settings.truth.lasers[1].alpha.value = 3 * kDegree;
  settings.truth.lasers[1].eta.value = 0.020;
  settings.truth.lasers[2].tau.value = 0.27;
  settings.truth.lasers[2].lambda.value += 4 * kDegree;
  const double rate = 1.7 * 2 * std::numbers::pi;
  const auto simulated = simulate_measurements(settings, plain_room(), Motion({{0, rate}}, 0.4));
  const Measurements& beams = simulated.beams;
  ASSERT_GT(beams.size(), 70'000U);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const auto& laser = settings.truth.lasers[beams.laser[i]];
    const double phi = 0.4 + rate * (beams.time[i] + laser.eta.value);
    const Vector3d x = equation_two(laser, phi, beams.mirror_angle[i], beams.range[i]);
    const double to_wall = std::min({std::abs(x.x() + 3), std::abs(x.x() - 5), std::abs(x.y() + 2),
                                     std::abs(x.y() - 4), std::abs(x.z() + 1), std::abs(x.z() - 2)});
    ASSERT_LT(to_wall, 1e-5) << i;  // angles are floats: 1e-7 rad on a slanting wall at 5 m
  }
}

TEST(SimulateMeasurements, SpreadsTheBeamsOverTheMirrorsTurn) {
  ScannerSettings settings = exact_settings();
  settings.mirror = {.frequency = 50, .slowest = 0, .wander = 0, .jitter = 0};
  const auto simulated = simulate_measurements(settings, plain_room());
  const Measurements& beams = simulated.beams;
  std::size_t first = 0;
  while (beams.beam[first] != 0) ++first;
  EXPECT_NEAR(beams.time[first + 540] - beams.time[first], 0.75 * 0.020, 1e-12);
  EXPECT_NEAR(beams.mirror_angle[first], -90 * kDegree, 1e-6);
  EXPECT_NEAR(beams.mirror_angle[first + 540], 180 * kDegree, 1e-6);
}

TEST(SimulateMeasurements, ItsNoiseHasTheStatedSpreadAndStep) {
  ScannerSettings settings;
  settings.duration = 2;
  const auto noisy = simulate_measurements(settings, office());
  settings.range.sigma = 0;
  settings.range.quantum = 0;
  const auto exact = simulate_measurements(settings, office());
  ASSERT_EQ(noisy.beams.size(), exact.beams.size());
  const auto n = static_cast<double>(noisy.beams.size());
  double s1 = 0;
  double s2 = 0;
  double s4 = 0;
  for (std::size_t i = 0; i < noisy.beams.size(); ++i) {
    const double error = double{noisy.beams.range[i]} - exact.beams.range[i];
    s1 += error;
    s2 += error * error;
    s4 += error * error * error * error;
    const double steps = noisy.beams.range[i] / 0.001;
    ASSERT_NEAR(steps, std::round(steps), 0.01);
  }
  const double variance = 0.012 * 0.012 + 0.001 * 0.001 / 12;
  EXPECT_NEAR(s1 / n, 0, 4 * std::sqrt(variance / n));
  EXPECT_NEAR(s2 / n, variance, 4 * variance * std::sqrt(2 / n));
  EXPECT_NEAR(s4 / n / variance / variance, 3, 4 * std::sqrt(96 / n));
}

TEST(SimulateMeasurements, HasKindsOfScansThatTakeTurns) {
  ScannerSettings settings = exact_settings();
  settings.laser_effects.resize(settings.rig.lasers.size());
  settings.laser_effects[0].interleave = {.shift = settings.field.step, .period = 3, .kind = 1};
  const auto beams = simulate_measurements(settings, plain_room(), Motion({{0, 0}}, 0)).beams;
  std::vector<float> at_199;
  std::vector<float> at_200;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams.laser[i] != 0) continue;
    if (beams.beam[i] == 199) at_199.push_back(beams.range[i]);
    if (beams.beam[i] == 200) at_200.push_back(beams.range[i]);
  }
  ASSERT_GT(at_199.size(), 6U);
  EXPECT_NE(at_199[0], at_200[0]);
  for (std::size_t scan = 0; scan < at_199.size(); ++scan) {
    EXPECT_NEAR(at_199[scan], scan % 3 == 1 ? at_200[0] : at_199[0], 1e-6) << scan;
  }
}

TEST(SimulateMeasurements, SeesNothingBeyondItsReach) {
  ScannerSettings settings;
  settings.duration = 1;
  const auto simulated = simulate_measurements(settings, street());
  EXPECT_GT(simulated.no_echo, 10'000U);
  EXPECT_LT(*std::max_element(simulated.beams.range.begin(), simulated.beams.range.end()), 50 + 6 * 0.012);
  EXPECT_GT(*std::max_element(simulated.beams.range.begin(), simulated.beams.range.end()), 45);
  EXPECT_GT(*std::min_element(simulated.beams.range.begin(), simulated.beams.range.end()), 0);
}

TEST(SimulateMeasurements, ReadsAnEncoderThatIsNeverMoreThanHalfACountOff) {
  ScannerSettings settings = exact_settings();
  const Motion motion = make_motion(settings.motion, settings.duration, 5);
  const auto simulated = simulate_measurements(settings, plain_room(), motion);
  const double count = 2 * std::numbers::pi / 16384;
  double worst = 0;
  for (std::size_t i = 0; i < simulated.plate.size(); ++i) {
    const double angle = simulated.plate.angles()[i];
    worst = std::max(worst, std::abs(angle - motion.at(simulated.plate.times()[i])->angle));
    ASSERT_NEAR(angle / count, std::round(angle / count), 1e-6);
  }
  EXPECT_LE(worst, count / 2 * (1 + 1e-9));
  EXPECT_GT(worst, count / 4);
}

TEST(SimulateMeasurements, IsTheSameForTheSameSeedOnly) {
  ScannerSettings settings;
  settings.duration = 0.5;
  const auto one = simulate_measurements(settings, office());
  const auto same = simulate_measurements(settings, office());
  settings.seed = 2;
  const auto other = simulate_measurements(settings, office());
  EXPECT_EQ(one.beams.range, same.beams.range);
  EXPECT_EQ(one.beams.time, same.beams.time);
  EXPECT_TRUE(std::ranges::equal(one.plate.angles(), same.plate.angles()));
  EXPECT_NE(one.beams.range, other.beams.range);
}

TEST(SimulateMeasurements, FiresOnlyTheBeamsThatAreRequested) {
  ScannerSettings settings;
  settings.duration = 1;
  settings.beams = {0, 360};  // the two in the plate's plane
  const auto simulated = simulate_measurements(settings, office());
  EXPECT_NEAR(static_cast<double>(simulated.beams.size()), 2 * 3 * 50, 3 * 2);
  for (std::size_t i = 0; i < simulated.beams.size(); ++i) {
    EXPECT_NEAR(std::abs(simulated.beams.mirror_angle[i]), 90 * kDegree, 1e-6);
  }
}

/// A range that reads 1 % and 5 cm short.
struct ShortRange : DifferentiableTerm<ShortRange> {
  const TermInfo& info() const override {
    static const TermInfo info{.name = "test.short",
                               .summary = "",
                               .phase = Phase::kRange,
                               .scope = Scope::kLaser,
                               .parameters = {{.name = "s", .unit = "1"}, {.name = "c", .unit = "m"}}};
    return info;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> parameters) const {
    beam.range = beam.range * (1.0 + parameters[0]) + parameters[1];
  }
};

TEST(SimulateMeasurements, ReportsTheRangeThatAModelTermCorrects) {
  TermRegistry terms;
  terms.add(std::make_shared<ShortRange>());
  ScannerSettings settings = exact_settings();
  settings.truth.lasers[0].terms = {{"test.short", {{"s", "1", 0.01}, {"c", "m", 0.05}}}};
  const Motion motion({{0, 0}}, 30 * kDegree);
  const auto simulated = simulate_measurements(settings, plain_room(), motion, terms);
  EXPECT_NEAR(range_at(simulated.beams, 0, 180), (1 - 0.05) / 1.01, 1e-6);
  EXPECT_NEAR(range_at(simulated.beams, 1, 180), 1, 1e-6) << "only laser 1 has the term";
}

TEST(SimulateMeasurements, RefusesSettingsThatMakeNoSense) {
  const auto with = [](auto change) {
    ScannerSettings settings;
    change(settings);
    return settings;
  };
  EXPECT_THROW(simulate_measurements(with([](auto& s) { s.duration = -1; }), office()), Error);
  EXPECT_THROW(simulate_measurements(with([](auto& s) { s.truth.lasers.pop_back(); }), office()), Error);
  EXPECT_THROW(simulate_measurements(with([](auto& s) { s.range.sigma = -1; }), office()), Error);
  EXPECT_THROW(simulate_measurements(with([](auto& s) { s.beams = {541}; }), office()), Error);
  EXPECT_THROW(simulate_measurements(with([](auto& s) { s.field.step = 0; }), office()), Error);
  EXPECT_THROW(simulate_measurements(with([](auto& s) { s.plate_frequency = 0; }), office()), Error);
}

}  // namespace
}  // namespace crisp
