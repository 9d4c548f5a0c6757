// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/scene_bound.hpp"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

#include "grabbers/simulate/paper.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "grabbers/simulate/shapes.hpp"
#include "pipeline/data/degree.hpp"
#include "plugins/study/bound_text.hpp"
#include "plugins/study/refinement_accuracy.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::simulate;
using namespace crisp::study;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kTurn = 2 * std::numbers::pi;

Motion motion_of(MotionKind kind, double duration) { return make_motion({.kind = kind}, duration, 5); }

SceneBound bound_in_the_office(const ScannerSettings& scanner) {
  return scene_bound(scanner, office(), motion_of(MotionKind::varying, scanner.duration), BeamChoice::kAll);
}

/// Equation (2) with (3) for a beam in the plate's plane, by hand: at α = 0 it leaves the laser, which sits
/// at τ on the plate's x axis, along ∓y (θ = ±90°: "side" −1 or +1).
class BeamInPlane {
 public:
  BeamInPlane(double range, double side, double tau, const PlateState& plate, double lambda)
      : rate_(plate.rate), psi_(plate.angle + lambda), laser_(tau, 0), beam_(0, side * range) {}

  Eigen::Vector2d direction() const { return turned(beam_.normalized()); }
  Eigen::Vector2d point() const { return turned(laser_ + beam_); }
  Eigen::Vector2d by_lambda() const { return turned(across(laser_ + beam_)); }
  Eigen::Vector2d by_tau() const { return turned(Eigen::Vector2d::UnitX()); }
  Eigen::Vector2d by_alpha() const { return turned(across(beam_)); }
  Eigen::Vector2d by_eta() const { return rate_ * by_lambda(); }

 private:
  static Eigen::Vector2d across(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }
  Eigen::Vector2d turned(const Eigen::Vector2d& v) const { return Eigen::Rotation2Dd(psi_) * v; }

  double rate_;
  double psi_;
  Eigen::Vector2d laser_;
  Eigen::Vector2d beam_;
};

/// The wall of the paper's room, by its line, on which a point lies.
std::size_t wall_of(const Eigen::Vector2d& point, const Scene& room, Eigen::Vector2d& normal) {
  std::size_t nearest = 0;
  double least = 1;
  for (std::size_t s = 0; s < room.surfaces.size(); ++s) {
    const auto& corners = room.surfaces[s].corners;
    Eigen::AlignedBox2d box;
    for (const auto& corner : corners) box.extend(corner.head<2>().eval());
    const Eigen::Vector2d along = box.max() - box.min();
    for (const Eigen::Vector2d& n :
         {Eigen::Vector2d(-along.y(), along.x()), Eigen::Vector2d(along.y(), along.x())}) {
      const Eigen::Vector2d unit = n.normalized();
      const auto off = [&](const Eigen::Vector3d& c) { return std::abs(unit.dot(c.head<2>() - point)); };
      double miss = box.exteriorDistance(point);
      for (const auto& corner : corners) miss = std::max(miss, off(corner));
      if (miss >= least) continue;
      least = miss;
      nearest = s;
      normal = unit;
    }
  }
  EXPECT_LT(least, 1e-5);  // ranges are floats
  return nearest;
}

TEST(SceneBound, OfThePapersBeamsIsThatWorkedOutByHand) {
  ScannerSettings scanner;
  scanner.duration = 4;
  scanner.range.sigma = 0.01;
  scanner.rig.lasers.resize(2);
  scanner.truth = nominal_calibration(scanner.rig);  // τ = 0.2 m, α = 0, λ = 0 and 120°, η = 0
  const Scene room = paper_room();
  const Motion motion = motion_of(MotionKind::varying, scanner.duration);
  const SceneBound bound = scene_bound(scanner, room, motion, BeamChoice::kInPlane);

  ScannerSettings exact = scanner;
  exact.range = {.sigma = 0, .quantum = 0};
  exact.encoder_quantised = false;
  const auto beams = simulate_beams(BeamChoice::kInPlane, exact, room, motion).beams;
  ASSERT_EQ(beams.size(), bound.beams);
  // Unknowns: τ₁ α₁ η₁ λ₂ τ₂ α₂ η₂, then the turn and the shift of each wall.
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(beams.size()),
                                                   7 + 2 * static_cast<Eigen::Index>(room.surfaces.size()));
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double lambda = beams.laser[i] == 0 ? 0 : kTurn / 3;
    const BeamInPlane beam(beams.range[i], beams.mirror_angle[i] > 0 ? 1 : -1, 0.2, *motion.at(beams.time[i]),
                           lambda);
    Eigen::Vector2d normal;
    const auto wall = static_cast<Eigen::Index>(wall_of(beam.point(), room, normal));
    if (std::abs(normal.dot(beam.direction())) < 0.05) continue;  // all but runs along it: does not count
    auto row = jacobian.row(static_cast<Eigen::Index>(i));
    const Eigen::Index first = beams.laser[i] == 0 ? 0 : 4;
    if (first > 0) row[3] = normal.dot(beam.by_lambda());
    row.segment<3>(first) << normal.dot(beam.by_tau()), normal.dot(beam.by_alpha()),
        normal.dot(beam.by_eta());
    row.segment<2>(7 + 2 * wall) << Eigen::Vector2d(-normal.y(), normal.x()).dot(beam.point()), 1;
    row /= 0.01 * normal.dot(beam.direction());
  }
  const Eigen::MatrixXd covariance = (jacobian.transpose() * jacobian).inverse();
  ASSERT_EQ(bound.parameters,
            (std::vector<std::string>{"laser1.tau", "laser1.alpha", "laser1.eta", "laser2.lambda",
                                      "laser2.tau", "laser2.alpha", "laser2.eta"}));
  // The rate between the encoder's readings, 2 ms apart, is that of a straight line.
  for (Eigen::Index k = 0; k < 7; ++k) {
    EXPECT_NEAR(bound.std_errors[k] / std::sqrt(covariance(k, k)), 1, 1e-3)
        << bound.parameters[static_cast<std::size_t>(k)];
  }
}

TEST(SceneBound, FallsWithTheRootOfTheNumberOfBeamsAndGrowsWithTheNoise) {
  ScannerSettings scanner;
  scanner.duration = 2;
  scanner.field.step = 2 * kDegree;
  const SceneBound coarse = bound_in_the_office(scanner);
  scanner.range.sigma *= 3;
  const SceneBound noisy = bound_in_the_office(scanner);
  scanner.field.step = 0.5 * kDegree;
  const SceneBound fine = bound_in_the_office(scanner);
  EXPECT_NEAR(static_cast<double>(fine.beams) / static_cast<double>(coarse.beams), 4, 0.05);
  for (Eigen::Index k = 0; k < 11; ++k) {
    EXPECT_NEAR(noisy.std_errors[k] / coarse.std_errors[k], 3, 1e-4) << k;
    // Four times as many beams between the same ends; small surfaces get more or less than their share.
    EXPECT_NEAR(noisy.std_errors[k] / fine.std_errors[k], 2, 0.1) << k;
  }
}

TEST(SceneBound, AtConstantSpeedKnowsEtaOnlyWithLambda) {
  ScannerSettings scanner;
  scanner.duration = 2;
  scanner.field.step = 2 * kDegree;
  const Motion steady = make_motion({.kind = MotionKind::constant, .max_rate = 1.5}, 2, 1);
  const SceneBound bound = scene_bound(scanner, office(), steady, BeamChoice::kAll);
  ASSERT_EQ(bound.unobservable.size(), 3U);
  EXPECT_EQ(bound.unobservable[1].parameter, "laser2.eta");
  EXPECT_EQ(bound.unobservable[1].combination, "laser2.lambda + 9.425 * laser2.eta");  // 1.5 turns a second
  EXPECT_TRUE(std::isinf(bound.std_errors[2])) << bound.parameters[2];
  EXPECT_TRUE(std::isfinite(bound.std_errors[3])) << bound.parameters[3];
  EXPECT_THAT(bound_text(bound),
              AllOf(HasSubstr("\nlaser2.eta          not determined; determined [SI] is laser2.lambda + "),
                    HasSubstr("\nlaser2.tau ")));
  EXPECT_THAT(bound_csv(bound), HasSubstr("\nlaser2.eta,s,,,,\"laser2.lambda + 9.425 * laser2.eta\"\n"));
}

TEST(SceneBound, ASpeedThatHardlyChangesDeterminesNoEta) {
  ScannerSettings scanner;
  scanner.duration = 4;
  scanner.field.step = 2 * kDegree;
  const MotionSettings varying{.kind = MotionKind::varying, .min_rate = 0.495, .max_rate = 0.505};
  const SceneBound bound =
      scene_bound(scanner, office(), make_motion(varying, scanner.duration, 1), BeamChoice::kAll);
  std::vector<std::string> names;
  for (const Unobservable& lost : bound.unobservable) {
    names.push_back(lost.parameter);
    EXPECT_THAT(lost.reason, HasSubstr("motion of the plate"));
  }
  EXPECT_THAT(names, testing::UnorderedElementsAre("laser1.eta", "laser2.eta", "laser3.eta"));
}

TEST(RefinementAccuracy, IsNoBetterThanTheBoundAndNotFarFromIt) {
  ScannerSettings scanner;
  scanner.duration = 2;
  for (const BeamChoice beams : {BeamChoice::kAll, BeamChoice::kInPlane}) {
    const Motion motion = motion_of(MotionKind::varying, 2);
    const SceneBound bound = scene_bound(scanner, office(), motion, beams);
    const RefinementAccuracy refinement =
        refinement_accuracy(scanner, office(), motion, beams, bound.parameters);
    ASSERT_EQ(refinement.failure, "");
    EXPECT_LT(refinement.beams, bound.beams);
    EXPECT_GT(refinement.beams, bound.beams / 2);
    const Eigen::ArrayXd ratio = refinement.std_errors.array() / bound.std_errors.array();
    // Its standard errors are estimated from the residuals, of which there are but 600 in the plane.
    const double chance = 3 / std::sqrt(2.0 * static_cast<double>(refinement.beams));
    EXPECT_GT(ratio.minCoeff(), 1 - chance);
    EXPECT_LT(ratio.maxCoeff(), 3);
    EXPECT_THAT(bound_text(bound, refinement), HasSubstr("   calibrate.refine\nlaser1.tau "));
  }
}

TEST(RefinementAccuracy, ReportsWhyThereIsNoResult) {
  ScannerSettings scanner;
  scanner.duration = 1;
  const Motion motion = motion_of(MotionKind::varying, 1);
  const std::vector<std::string> parameters = {"laser1.tau"};
  scanner.range.max_distance = 0.5;  // nothing is so near
  const RefinementAccuracy refinement =
      refinement_accuracy(scanner, office(), motion, BeamChoice::kAll, parameters);
  EXPECT_NE(refinement.failure, "");
}

TEST(SceneBound, AFloorAloneDeterminesNothing) {
  // λ, τ, α and η all move points within a floor at right angles to the spin axis.
  const Scene floor{
      "floor", {{.name = "floor", .corners = {{-20, -20, -1}, {20, -20, -1}, {20, 20, -1}, {-20, 20, -1}}}}};
  ScannerSettings scanner;
  scanner.duration = 1;
  const SceneBound bound = scene_bound(scanner, floor, motion_of(MotionKind::varying, 1), BeamChoice::kAll);
  EXPECT_EQ(bound.unobservable.size(), 11U);
  EXPECT_TRUE(bound.std_errors.array().isInf().all());
  EXPECT_EQ(bound.beams_on, std::vector<std::size_t>{bound.beams});
  EXPECT_GT(bound.no_echo, bound.beams / 2);  // upwards
}

TEST(SceneBound, ReportsASceneWithoutSurfaces) {
  ScannerSettings scanner;
  scanner.duration = 1;
  scanner.range.max_distance = 0.5;
  EXPECT_THROW(scene_bound(scanner, office(), motion_of(MotionKind::varying, 1), BeamChoice::kAll), Error);
}

TEST(BeamChoice, InThePlanesPlaneAreEachLasersOwnTwo) {
  ScannerSettings scanner;
  scanner.duration = 1;
  scanner.rig.lasers[1].mount += 10 * kDegree;
  const Motion motion = motion_of(MotionKind::varying, 1);
  const auto simulated = simulate_beams(BeamChoice::kInPlane, scanner, office(), motion);
  ASSERT_EQ(simulated.surface.size(), simulated.beams.size());
  EXPECT_NEAR(static_cast<double>(simulated.beams.size()), 2 * 3 * 50, 6);  // two a turn of three mirrors
  for (std::size_t i = 0; i < simulated.beams.size(); ++i) {
    EXPECT_NEAR(std::abs(simulated.beams.mirror_angle[i]), 90 * kDegree, 1e-6);
  }
  scanner.field.first = 0;
  scanner.field.last = 90 * kDegree;
  EXPECT_THROW(simulate_beams(BeamChoice::kInPlane, scanner, office(), motion), Error);
}

}  // namespace
}  // namespace crisp
