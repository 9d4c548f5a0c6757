// SPDX-License-Identifier: BSD-3-Clause
// Rigs other than the demo's, as another simulator draws them (tests/independent): those that once came out
// wrong, or right and untrusted.
#include <gmock/gmock.h>

#include <sstream>

#include "pipeline/files/calibration_file.hpp"
#include "tests/end_to_end/drawn_rig.hpp"
#include "tests/end_to_end/workshop.hpp"

namespace crisp {
namespace {

using testing::HasSubstr;

class AnyRig : public testing::Test {
 protected:
  test::Outcome calibrate(std::uint64_t seed, const std::vector<std::string>& fixed) {
    drawn_.emplace(workshop_ / "drawn", seed, fixed);
    return workshop_.run("calibrate.yaml", drawn_->capture(), "out", {}, drawn_->rig());
  }

  void is_right_and_trusted(std::uint64_t seed, const std::vector<std::string>& fixed = {"fault=none"}) {
    const auto outcome = calibrate(seed, fixed);
    EXPECT_EQ(outcome.status, ExitStatus::done) << drawn_->words() << "\n" << outcome.told;
    for (const auto& parameter : drawn_->compare(read_calibration(workshop_ / "out/calibration.yaml"))) {
      EXPECT_FALSE(parameter.is_wrong()) << drawn_->words() << ": " << parameter.name << " "
                                         << parameter.error << " ± " << parameter.std_error;
    }
  }

  void is_told(std::uint64_t seed, const std::vector<std::string>& fixed, const std::string& what) {
    const auto outcome = calibrate(seed, fixed);
    EXPECT_EQ(outcome.status, ExitStatus::not_trusted) << drawn_->words();
    EXPECT_THAT(outcome.told, HasSubstr(what)) << drawn_->words();
  }

  test::Workshop workshop_;
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

TEST_F(AnyRig, InACorridorTheNominalLambdaTellsWhichWayRound) { is_right_and_trusted(160); }

TEST_F(AnyRig, ALoneLaserTellsTheDirectionByTheSignOfItsTau) { is_right_and_trusted(622, {}); }

TEST_F(AnyRig, ALagAtWhichLinesFitByChanceIsNotTaken) {
  const auto outcome = calibrate(581, {"fault=none"});
  EXPECT_THAT(outcome.told, HasSubstr("left.eta has another minimum at 99.93 ms"));
  for (const auto& parameter : drawn_->compare(read_calibration(workshop_ / "out/calibration.yaml"))) {
    EXPECT_FALSE(parameter.is_wrong())
        << parameter.name << " " << parameter.error << " ± " << parameter.std_error;
  }
}

TEST_F(AnyRig, DelaysThatThinOutTowardsTheLeastLeaveEtaHonest) { is_right_and_trusted(25, {}); }

TEST_F(AnyRig, ADirectionThatNothingShowsIsNotGuessed) {
  is_told(11, {}, "nothing shows which way the encoder counts");
}

TEST_F(AnyRig, AMountThatIsOffByDegreesIsFound) {
  is_told(12, {}, "the rig has 3.283 deg");
  is_told(301, {"fault=mount"}, "front's mount is off: 44.99");
}

TEST_F(AnyRig, MountsThatAreOffByARightAngleAreFound) {
  is_told(302, {"fault=mount"}, "with mount: 45.1deg of front (the rig has -44.9)");
}

TEST_F(AnyRig, ALaserThatSendsNothingIsNamed) {
  const auto outcome = calibrate(18, {});
  EXPECT_THAT(outcome.told, HasSubstr("front: nothing came from it"));
}

}  // namespace
}  // namespace crisp
