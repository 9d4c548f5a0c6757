// SPDX-License-Identifier: BSD-3-Clause
// Rigs other than the demo's, as another simulator draws them (tests/independent): those that once came out
// wrong, or right and untrusted.
#include <gmock/gmock.h>

#include <crisp/atomic_file.hpp>
#include <crisp/calibration_file.hpp>

#include "pipeline/files/yaml.hpp"
#include "tests/end_to_end/drawn_rig.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using testing::HasSubstr;

class AnyRig : public testing::Test {
 protected:
  test::Outcome calibrate(std::uint64_t seed, const std::vector<std::string>& fixed) {
    drawn_.emplace(fixture_ / "drawn", seed, fixed);
    return fixture_.run("calibrate.yaml", drawn_->capture(), "out", {}, drawn_->rig());
  }

  void is_right_and_trusted(std::uint64_t seed, const std::vector<std::string>& fixed = {"fault=none"}) {
    const auto outcome = calibrate(seed, fixed);
    EXPECT_EQ(outcome.status, ExitStatus::done) << drawn_->words() << "\n" << outcome.console;
    for (const auto& parameter : drawn_->compare(read_calibration(fixture_ / "out/calibration.yaml"))) {
      EXPECT_FALSE(parameter.is_wrong()) << drawn_->words() << ": " << parameter.name << " "
                                         << parameter.error << " ± " << parameter.std_error;
    }
  }

  void is_untrusted_with(std::uint64_t seed, const std::vector<std::string>& fixed, const std::string& what) {
    const auto outcome = calibrate(seed, fixed);
    EXPECT_EQ(outcome.status, ExitStatus::not_trusted) << drawn_->words();
    EXPECT_THAT(outcome.console, HasSubstr(what)) << drawn_->words();
  }

  test::PipelineFixture fixture_;
  std::optional<test::DrawnRig> drawn_;
};

TEST_F(AnyRig, OneSidedLasersAreRightThoughAnEntropyWouldFoldTheRoom) {
  is_right_and_trusted(13, {});
  is_right_and_trusted(16, {});
}

TEST_F(AnyRig, APlateThatStopsAndGoesShowsWallsInStripes) { is_right_and_trusted(127); }

TEST_F(AnyRig, ACoarseEncoderCountsInTheStandardErrors) {
  is_right_and_trusted(139);
  is_right_and_trusted(167);
}

TEST_F(AnyRig, AWallThatBeamsGrazeDoesNotTurnLasersNearTheAxis) {
  is_right_and_trusted(5213, {"fault=none", "duration=10", "has_effect=1", "has_mixed_pixels=0", "lasers=2",
                              "effect=none", "counts=40000"});
}

TEST_F(AnyRig, InACorridorTheNominalLambdaDeterminesTheDirection) { is_right_and_trusted(160); }

TEST_F(AnyRig, ALoneLaserDeterminesTheDirectionByTheSignOfItsTau) { is_right_and_trusted(622, {}); }

TEST_F(AnyRig, ALagAtWhichLinesFitByChanceIsNotTaken) {
  const auto outcome = calibrate(581, {"fault=none"});
  EXPECT_THAT(outcome.console, testing::AnyOf(HasSubstr("left.eta has a competing minimum at 99."),
                                              HasSubstr("left.eta has a competing minimum at 100 ms")));
  for (const auto& parameter : drawn_->compare(read_calibration(fixture_ / "out/calibration.yaml"))) {
    EXPECT_FALSE(parameter.is_wrong())
        << parameter.name << " " << parameter.error << " ± " << parameter.std_error;
  }
}

TEST_F(AnyRig, DelaysThatThinOutTowardsTheLeastLeaveEtaHonest) { is_right_and_trusted(25, {}); }

TEST_F(AnyRig, AClockwiseEncoderIsFoundWhereTheSearchMissesTheMirrorImage) {
  is_right_and_trusted(7210,
                       {"fault=none", "duration=10", "has_effect=1", "has_mixed_pixels=0", "effect=none"});
}

TEST_F(AnyRig, ADirectionThatNothingShowsIsNotGuessed) {
  is_untrusted_with(11, {}, "the encoder's sense of rotation is undetermined");
}

TEST_F(AnyRig, ADirectionThatOnlyTheEntropysOptimumShowsIsNotTrusted) {
  // Addresses of lasers that face each other are exchanged: the mirror image agrees with the rig.
  is_untrusted_with(8010, {"duration=8"}, "the encoder's sense of rotation is undetermined");
}

TEST_F(AnyRig, AnEntropysLocalMinimumIsLeftByTheRigsValues) { is_right_and_trusted(8505, {}); }

TEST_F(AnyRig, VeilsOfMixedPixelsAreNoWalls) { is_right_and_trusted(8060, {}); }

TEST_F(AnyRig, AMinimumThatContradictsTheRigIsLeftByItsValues) { is_right_and_trusted(8036, {}); }

TEST_F(AnyRig, ALaserThatAgreesWithNoOtherIsAddedToThoseThatAgree) { is_right_and_trusted(9012, {}); }

TEST_F(AnyRig, LasersOfWhichFewAgreeAreCalibratedOneByOne) {
  is_right_and_trusted(6022, {"fault=none", "duration=8"});
}

TEST_F(AnyRig, AMinimumThatContradictsTheRigIsLeftLaserByLaser) { is_right_and_trusted(9052, {}); }

TEST_F(AnyRig, ALagThatAWrongLambdaMakesUpForShowsAtStops) { is_right_and_trusted(9092, {}); }

TEST_F(AnyRig, TooLargeCountsThatSqueezeTheSceneAreFound) {
  is_untrusted_with(90205,
                    {"fault=counts", "counts=4096", "counts_fault=1", "duration=7", "kind=lms1xx", "lasers=2",
                     "mode=0", "motion=varied", "mount=45", "odd_mount=0", "orientation=tangential",
                     "scene=office", "tilted=0", "has_mixed_pixels=0", "has_sd=0", "azimuths=even"},
                    "plate.counts_per_revolution: 4096 (the rig has 16384)");
}

TEST_F(AnyRig, CountsThatSqueezeAScanThatViewsAgreeOnAreFound) {
  is_untrusted_with(9134, {}, "plate.counts_per_revolution: 85209 (the rig has 340836)");
  is_untrusted_with(9091, {}, "plate.counts_per_revolution: 1432 (the rig has 358)");
}

TEST_F(AnyRig, CountsAreFoundAtAnEvenRateAtWhichFewAnglesRecur) {
  is_untrusted_with(9229, {}, "plate.counts_per_revolution: 11348 (the rig has 2837)");
}

TEST_F(AnyRig, AMountThatFoldsTheSceneOntoFewSurfacesIsFound) {
  is_untrusted_with(9146, {}, "mount: 90deg of front (the rig has 180)");
  // Turned by another quarter, views agree, with half of the beams.
  std::string rig = files::read_text_file(drawn_->rig(), 1 << 20);
  const std::string mount = "mount: 180deg";
  rig.replace(rig.find(mount), mount.size(), "mount: 0deg");
  write_file(fixture_ / "other.yaml", rig);
  const auto outcome =
      fixture_.run("calibrate.yaml", drawn_->capture(), "other", {}, fixture_ / "other.yaml");
  EXPECT_EQ(outcome.status, ExitStatus::not_trusted);
  EXPECT_THAT(outcome.console, HasSubstr("mount: 90deg of front (the rig has 0)"));
}

TEST_F(AnyRig, AMountIsFoundAtAConstantSpeed) {
  is_untrusted_with(9010, {}, "mount: 90deg of front (the rig has 135)");
}

TEST_F(AnyRig, ASlipFasterThanAPlateCanTurnIsCorrected) { is_right_and_trusted(20003, {"fault=slip"}); }

TEST_F(AnyRig, BeamsThatCoincideAfterThreeTurnsAtAConstantRateShowNoWrongCounts) {
  const auto outcome = calibrate(9019, {});
  EXPECT_THAT(outcome.console, HasSubstr("these data determine 2 of 7 parameters only"));
  EXPECT_THAT(outcome.console, testing::Not(HasSubstr("counts_per_revolution")));
}

TEST_F(AnyRig, ADirectionThatOnlyTheRigKnowsIsCalledSo) {
  const auto outcome = calibrate(573, {"duration=6"});  // stated wrongly, and a mirror image agrees as well
  EXPECT_THAT(outcome.console, HasSubstr("counter_clockwise is known from the rig only"));
  EXPECT_EQ(read_calibration(fixture_ / "out/calibration.yaml").provenance.at("direction_from"), "rig");
  EXPECT_EQ(outcome.stage("calibrate.refine").at("report").at("direction_from"), "rig");
}

TEST_F(AnyRig, AMountThatIsOffByDegreesIsFound) {
  is_untrusted_with(12, {}, "the rig has 3.283 deg");
  is_untrusted_with(301, {"fault=mount"}, "front's mount is off: 44.99");
}

TEST_F(AnyRig, MountsThatAreOffByARightAngleAreFound) {
  is_untrusted_with(302, {"fault=mount"}, "with mount: 45.1deg of front (the rig has -44.9)");
}

TEST_F(AnyRig, ExchangedLasersThatFaceEachOtherAreFound) {
  is_untrusted_with(2009, {}, "the addresses of front and left exchanged");
}

TEST_F(AnyRig, ALaserThatSendsNothingIsNamed) {
  const auto outcome = calibrate(18, {});
  EXPECT_THAT(outcome.console, HasSubstr("front: no data of it"));
}

}  // namespace
}  // namespace crisp
