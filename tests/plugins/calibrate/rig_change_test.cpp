// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_change.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using namespace crisp::estimate;
using testing::Each;
using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Truly;

Rig rig_of_two() {
  Rig rig = default_rig();
  rig.lasers.resize(2);
  rig.lasers[0].mount = 0.1;
  rig.lasers[1].mount = 0.7;
  return rig;
}

/// A beam of each of two lasers, while the plate turns at 1 rad/s.
class RigChanges : public testing::Test {
 protected:
  RigChanges() {
    sample_.beams = {.range = {2, 3},
                     .mirror_angle = {0.3F, 0.4F},
                     .time = {1, 1},
                     .laser = {0, 1},
                     .remission = {0, 0},
                     .beam = {0, 0},
                     .cos_incidence = {}};
    sample_.plate = &plate_;
  }

  Rig rig_ = rig_of_two();
  PlateTrajectory plate_{0, {0, 1, 2}, {0, 1, 2}, 5};
  Sample sample_;
};

TEST_F(RigChanges, NoneLeavesTheDataAsTheyAre) {
  const ChangedSample changed(sample_, no_change(rig_));
  EXPECT_EQ(changed.sample().beams.mirror_angle, sample_.beams.mirror_angle);
  EXPECT_EQ(changed.sample().beams.laser, sample_.beams.laser);
  EXPECT_THAT(changed.sample().plate->angles(), ElementsAre(0, 1, 2));
}

TEST_F(RigChanges, OfThePlateMultiplyItsAngles) {
  const auto angle_with = [&](const RigChange& change) {
    return ChangedSample(sample_, change).sample().plate->at(1)->angle;
  };
  EXPECT_NEAR(angle_with(other_direction(rig_)), -1, 1e-12);
  const RigChange fourfold = other_counts(rig_).front();
  EXPECT_NEAR(angle_with(fourfold), 4, 1e-12) << "a quarter of the counts makes a turn";
  EXPECT_THAT(fourfold.words, HasSubstr("(the rig has "));
}

TEST_F(RigChanges, OfALaserLeaveTheOtherAlone) {
  for (const RigChange& change : changes_of_laser(rig_, 1)) {
    const ChangedSample changed(sample_, change);
    EXPECT_EQ(changed.sample().beams.mirror_angle[0], 0.3F) << change.words;
    EXPECT_NE(changed.sample().beams.mirror_angle[1], 0.4F) << change.words;
  }
}

TEST_F(RigChanges, UpsideDownALasersAnglesGrowTheOtherWay) {
  const RigChange upside_down = changes_of_laser(rig_, 1).front();
  EXPECT_THAT(upside_down.words, HasSubstr("180deg of laser2, which is upside down"));
  EXPECT_THAT(ChangedSample(sample_, upside_down).sample().beams.mirror_angle,
              ElementsAre(0.3F, FloatNear(-0.4F, 1e-6F)));
}

TEST_F(RigChanges, AGreaterMountMakesAnglesSmaller) {
  const RigChange by_half_a_turn = other_mounts(rig_).front();
  const auto half = static_cast<float>(std::numbers::pi);
  EXPECT_THAT(ChangedSample(sample_, by_half_a_turn).sample().beams.mirror_angle,
              ElementsAre(FloatNear(0.3F - half, 1e-6F), FloatNear(0.4F - half, 1e-6F)));
}

TEST_F(RigChanges, ExchangedLasersHaveEachOthersMount) {
  const auto all = exchanges(rig_);
  ASSERT_EQ(all.size(), 1U);
  const ChangedSample changed(sample_, all.front());
  EXPECT_THAT(changed.sample().beams.laser, ElementsAre(1, 0));
  // Reported angles are 0.4 and 1.1: less the mount of the other laser.
  EXPECT_THAT(changed.sample().beams.mirror_angle,
              ElementsAre(FloatNear(0.4F - 0.7F, 1e-6F), FloatNear(1.1F - 0.1F, 1e-6F)));
}

TEST_F(RigChanges, BeamsOfOneDeviceAreNotExchanged) {
  rig_.lasers[1].address = rig_.lasers[0].address;
  EXPECT_TRUE(exchanges(rig_).empty());
  rig_.lasers[1].topic = "/scan2";
  EXPECT_EQ(exchanges(rig_).size(), 1U);
}

TEST_F(RigChanges, CombinationsThatChangeLasersAlikeComeFirst) {
  const auto all = combinations({changes_of_laser(rig_, 0), changes_of_laser(rig_, 1)}, 100);
  ASSERT_EQ(all.size(), 36U);
  const auto is_alike = [](const RigChange& change) { return change.lasers[0] == change.lasers[1]; };
  EXPECT_THAT(std::vector(all.begin(), all.begin() + 6), Each(Truly(is_alike)));
  EXPECT_THAT(all.front().words, HasSubstr("laser1, which is upside down (the rig has 0), alpha:"));
  EXPECT_TRUE(combinations({}, 100).empty());
}

TEST_F(RigChanges, OfManyLasersAreCombinedToTheRequestedNumber) {
  const auto all = combinations(std::vector(40, changes_of_laser(rig_, 0)), 8);
  EXPECT_EQ(all.size(), 8U);
}

TEST_F(RigChanges, ThatAreAlikeAreHalfTurnsAndExchanges) {
  const auto of_one = changes_of_laser(rig_, 0);
  EXPECT_TRUE(are_alike(of_one[0], of_one[1])) << "upside down, and a mount turned by 180 degrees";
  for (std::size_t k = 2; k < of_one.size(); ++k)
    EXPECT_FALSE(are_alike(of_one[0], of_one[k])) << of_one[k].words;
  EXPECT_TRUE(are_alike(exchanges(rig_)[0], exchanges(rig_)[0]));
  EXPECT_FALSE(are_alike(exchanges(rig_)[0], of_one[0]));
  EXPECT_FALSE(are_alike(other_direction(rig_), other_counts(rig_)[0]));
}

}  // namespace
}  // namespace crisp
