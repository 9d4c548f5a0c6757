// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_check.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include <crisp/sensor_model.hpp>

#include "pipeline/data/oriented_plate.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using namespace crisp::data;
using namespace crisp::estimate;
using namespace crisp::simulate;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// What a calibration finds on the default rig, or on another: its truth, off the nominal values by up to 2
/// cm, 3° and 5°.
Calibration found(std::uint64_t seed, const Rig& rig = default_rig()) {
  Calibration calibration = nominal_calibration(rig);
  const Calibration truth = misplaced_scanner(seed, 1).truth;
  const Calibration nominal = nominal_calibration(default_rig());
  for (std::size_t k = 0; k < calibration.lasers.size(); ++k) {
    LaserCalibration& laser = calibration.lasers[k];
    laser.lambda.value += truth.lasers[k].lambda.value - nominal.lasers[k].lambda.value;
    laser.tau.value += truth.lasers[k].tau.value - nominal.lasers[k].tau.value;
    laser.alpha.value += truth.lasers[k].alpha.value - nominal.lasers[k].alpha.value;
    laser.lambda.free = k > 0;
  }
  return calibration;
}

RigCheck check(const Calibration& calibration, const Rig& rig = default_rig()) {
  return check_with_rig(calibration, rig, ParameterPrior{});
}

TEST(RigCheck, MirroredPlacesTheMirrorImageOfTheSceneByNegatedCounts) {
  const auto recording = simulate_measurements(misplaced_scanner(3, 0.2), office());
  const Placed scene = SensorModel(recording.truth).place(recording.beams, recording.plate);
  const Placed image =
      SensorModel(mirrored(recording.truth)).place(recording.beams, reversed(recording.plate));
  ASSERT_EQ(image.points.cols(), scene.points.cols());
  // The frame keeps the first laser's λ, so that the mirror is the plane in which that laser lies at φ = 0,
  // turned by a quarter: x → −x.
  const Eigen::Matrix3Xd expected = Eigen::Vector3d(-1, 1, 1).asDiagonal() * scene.points;
  EXPECT_LT((image.points - expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(RigCheck, AgreementWithTheRigGivesNoCaveat) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const RigCheck result = check(found(seed));
    EXPECT_THAT(result.caveats, IsEmpty());
    EXPECT_FALSE(result.is_mirrored);
    EXPECT_TRUE(result.knows_direction);
  }
}

TEST(RigCheck, NegatedCountsAreNamed) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const RigCheck result = check(mirrored(found(seed)));
    EXPECT_TRUE(result.is_mirrored);
    EXPECT_THAT(result.caveats, ElementsAre(HasSubstr("Set plate.direction: counter_clockwise in the rig")));
  }
  Rig rig = default_rig();
  rig.plate.direction = CountDirection::clockwise;
  EXPECT_THAT(check(mirrored(found(1, rig)), rig).caveats, ElementsAre(HasSubstr("direction: clockwise in")));
}

TEST(RigCheck, TheOrderOfTheLasersDeterminesTheDirectionOfRadialScanPlanes) {
  Rig rig = default_rig();
  for (auto& laser : rig.lasers) laser.nominal.alpha.value = 90 * kDegree;
  EXPECT_TRUE(check(found(4, rig), rig).knows_direction);
  Calibration three = found(4, rig);
  note_direction(three, rig, check(three, rig));
  EXPECT_EQ(three.provenance.at(kDirectionSource), kFromRecording);
  EXPECT_TRUE(check(mirrored(found(4, rig)), rig).is_mirrored);
  rig.lasers.resize(2);
  rig.lasers[1].nominal.lambda.value = 180 * kDegree;
  const RigCheck two = check(found(4, rig), rig);
  EXPECT_FALSE(two.knows_direction) << "two radial lasers opposite one another are their own mirror image";
  Calibration noted = found(4, rig);
  note_direction(noted, rig, two);
  EXPECT_EQ(noted.provenance.at(kDirectionSource), kFromRig);
  EXPECT_FALSE(leaves_direction_open(rig, two));
  rig.plate.direction = CountDirection::automatic;
  EXPECT_TRUE(leaves_direction_open(rig, check(noted, rig)));
  note_direction(noted, rig, check(noted, rig));
  EXPECT_FALSE(noted.provenance.contains(kDirectionSource));
  EXPECT_THAT(two.caveats, IsEmpty());
}

TEST(RigCheck, ALoneLaserUpsideDownIsTheMirrorImageWhereTheDirectionIsOpen) {
  Rig rig = default_rig();
  rig.lasers.resize(1);
  rig.plate.direction = CountDirection::automatic;
  const Calibration truth = found(6, rig);
  const RigCheck result = check(mirrored(truth), rig);
  EXPECT_TRUE(result.is_mirrored);
  const auto turned = in_direction_of_rig(mirrored(truth), rig, result);
  ASSERT_TRUE(turned);
  EXPECT_EQ(turned->direction, CountDirection::counter_clockwise);
  EXPECT_NEAR(turned->lasers[0].tau.value, truth.lasers[0].tau.value, 1e-12);
  EXPECT_NEAR(turned->lasers[0].alpha.value, truth.lasers[0].alpha.value, 1e-12);
  EXPECT_FALSE(in_direction_of_rig(truth, rig, check(truth, rig)));
  rig.plate.direction = CountDirection::counter_clockwise;
  EXPECT_FALSE(in_direction_of_rig(mirrored(truth), rig, check(mirrored(truth), rig)));
}

TEST(RigCheck, ExchangedLasersAreNamed) {
  Rig rig = default_rig();
  rig.lasers[1].nominal.tau.value = 0.25;
  Calibration calibration = found(5, rig);
  std::swap(calibration.lasers[1].lambda, calibration.lasers[2].lambda);
  std::swap(calibration.lasers[1].tau, calibration.lasers[2].tau);
  EXPECT_THAT(check(calibration, rig).caveats, ElementsAre(HasSubstr("laser2 and laser3 are exchanged")));
}

TEST(RigCheck, ExchangedLasersAreNamedByTauAloneInAWrongLocalMinimum) {
  Rig rig = default_rig();
  rig.lasers[1].nominal.tau.value = 0.48;
  Calibration calibration = found(5, rig);
  std::swap(calibration.lasers[1].tau, calibration.lasers[2].tau);
  for (std::size_t k : {1, 2}) calibration.lasers[k].lambda.value += 80 * kDegree;
  EXPECT_THAT(check(calibration, rig).caveats,
              testing::Contains(HasSubstr("laser2 and laser3 are probably exchanged")));
  calibration.lasers[1].tau.value = 0.7;  // no laser's nominal value
  EXPECT_THAT(check(calibration, rig).caveats,
              testing::Not(testing::Contains(HasSubstr("probably exchanged"))));
}

TEST(RigCheck, ALaserThatIsUpsideDownIsNamed) {
  Calibration calibration = found(6);
  calibration.lasers[2].alpha.value += std::numbers::pi;
  EXPECT_THAT(check(calibration).caveats, ElementsAre(HasSubstr("laser3 is mounted upside down")));
  for (std::size_t k : {0, 1}) calibration.lasers[k].alpha.value += std::numbers::pi;
  EXPECT_THAT(check(calibration).caveats, ElementsAre(HasSubstr("all lasers are mounted upside down")));
}

TEST(RigCheck, LasersThatFaceEachOtherLeaveOpenWhetherTheyOrTheDirectionAreWrong) {
  Rig rig = default_rig();
  rig.lasers.resize(2);
  rig.lasers[1].nominal.lambda.value = 180 * kDegree;
  const RigCheck result = check(mirrored(found(7, rig)), rig);
  ASSERT_EQ(result.caveats.size(), 1U);
  EXPECT_THAT(result.caveats[0],
              testing::AllOf(HasSubstr("2 corrections of the rig fit, the likeliest first"),
                             HasSubstr("a mirror image of the scene"),
                             HasSubstr("Set plate.direction: counter_clockwise"),
                             HasSubstr("Turn each mount, or each nominal alpha, by 180 degrees")));
}

TEST(RigCheck, ExchangesThatFitAreListedWithTheLikeliestFirst) {
  Rig rig = default_rig();
  rig.lasers[1].nominal.lambda.value = 104 * kDegree;
  rig.lasers[2].nominal.lambda.value = 231 * kDegree;
  Calibration calibration = found(8, rig);
  std::swap(calibration.lasers[0].lambda, calibration.lasers[1].lambda);
  const RigCheck result = check(calibration, rig);
  ASSERT_EQ(result.caveats.size(), 1U);
  EXPECT_THAT(result.caveats[0], HasSubstr("laser1 and laser2 are exchanged"));
  EXPECT_THAT(result.caveats[0], HasSubstr("each lambda has the other sign")) << "0, -104 and 127 for -231";
  EXPECT_THAT(result.caveats[0], testing::Not(HasSubstr("mirror image")));
  EXPECT_LT(result.caveats[0].find("laser1 and laser2"), result.caveats[0].find("3) "));
}

TEST(RigCheck, AzimuthsOfTheOtherSignAreNoExchange) {
  Rig rig = default_rig();
  rig.lasers[1].nominal.lambda.value = 165 * kDegree;
  rig.lasers[2].nominal.lambda.value = 40 * kDegree;
  Calibration calibration = found(8, rig);
  for (LaserCalibration& laser : calibration.lasers) laser.lambda.value *= -1;
  EXPECT_THAT(check(calibration, rig).caveats,
              ElementsAre(testing::AllOf(HasSubstr("each lambda has the other sign"),
                                         testing::Not(HasSubstr("exchanged")))));
}

TEST(RigCheck, ALambdaFarFromItsNominalValueIsReported) {
  Rig rig = default_rig();
  Calibration calibration = found(9, rig);
  calibration.lasers[1].lambda.value += 65 * kDegree;
  EXPECT_THAT(check(calibration, rig).caveats, ElementsAre(HasSubstr("laser2.lambda is")));
  calibration.lasers[1].lambda.value -= 35 * kDegree;
  EXPECT_THAT(check(calibration, rig).caveats, IsEmpty()) << "rough nominal values are no mistake";
  calibration.lasers[1].lambda.value += 35 * kDegree;
  calibration.lasers[1].lambda.std_error = 20 * kDegree;
  EXPECT_THAT(check(calibration, rig).caveats, IsEmpty());
}

TEST(RigCheck, AParameterOutsideItsRangeIsReportedWithItsNominalValue) {
  Calibration calibration = found(7);
  calibration.lasers[1].tau.value = 0.487;
  calibration.lasers[2].alpha.value = -0.61;
  EXPECT_THAT(
      check(calibration).caveats,
      ElementsAre(
          HasSubstr("laser2.tau is 487.0 mm, not within tau_range (100.0 mm) of the rig's nominal 200.0 mm"),
          HasSubstr("laser3.alpha is -35.0 deg, not within alpha_range (20.1 deg)")));
}

TEST(RigCheck, WhatAStartHasHadIsNoNewContradiction) {
  const Rig rig = default_rig();
  Calibration start = found(9);
  Calibration refined = start;
  start.lasers[0].tau.value = 0.35;  // within a larger tau_range
  start.lasers[1].lambda.value += 75 * kDegree;
  refined.lasers[0].tau.value = 0.36;
  refined.lasers[1].lambda.value += 76 * kDegree;
  EXPECT_THAT(new_contradictions(refined, start, rig), IsEmpty());
  EXPECT_THAT(check(refined).caveats, SizeIs(2));
  start.lasers[2].alpha.value += 2 * std::numbers::pi;  // the same angle widens no range
  refined.lasers[2].tau.value = -2.5;
  refined.lasers[2].alpha.value += 30 * kDegree;
  EXPECT_THAT(new_contradictions(refined, start, rig),
              ElementsAre(HasSubstr("laser3.tau is -2500.0 mm"), HasSubstr("laser3.alpha is")));
}

TEST(RigCheck, TheRigsStandardDeviationsAreItsLimits) {
  Rig rig = default_rig();
  rig.lasers[1].nominal.lambda.std_error = 1 * kDegree;
  rig.lasers[2].nominal.tau.std_error = 0.002;
  Calibration calibration = nominal_calibration(rig);
  for (std::size_t k : {1, 2}) calibration.lasers[k].lambda.free = true;
  EXPECT_THAT(check(calibration, rig).caveats, IsEmpty());
  calibration.lasers[1].lambda.value += 4 * kDegree;
  calibration.lasers[2].lambda.value += 4 * kDegree;  // without a standard deviation in the rig
  calibration.lasers[2].tau.value += 0.007;
  EXPECT_THAT(check(calibration, rig).caveats,
              ElementsAre(HasSubstr("laser2.lambda is 124.0 deg, not within 3 standard deviations (3.0 deg)"),
                          HasSubstr("laser3.tau is 207.0 mm, not within 3 standard deviations (6.0 mm)")));
}

TEST(RigCheck, ALaserNearTheAxisMayBeOnEitherSideOfIt) {
  Rig rig = default_rig();
  rig.lasers.resize(1);
  rig.lasers[0].nominal.tau.value = 0.01;
  const RigCheck one = check(mirrored(found(1, rig)), rig);
  EXPECT_FALSE(one.knows_direction);
  EXPECT_FALSE(one.is_mirrored);
  EXPECT_THAT(one.caveats, IsEmpty());
}

}  // namespace
}  // namespace crisp
