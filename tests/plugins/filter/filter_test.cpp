// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <limits>

#include <crisp/cloud.hpp>
#include <crisp/error.hpp>
#include <crisp/first_in_voxel.hpp>

#include "plugins/filter/limits_stages.hpp"
#include "plugins/filter/voxel_stage.hpp"
#include "tests/support/stage_driver.hpp"

namespace crisp {
namespace {

using namespace crisp::filter;
using test::StageDriver;
using testing::ElementsAre;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Point point_at(float x, float y, float z, double time = 0) {
  Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  point.time = time;
  return point;
}

Cloud cloud_of(std::initializer_list<Point> points) {
  Cloud cloud;
  for (const auto& point : points) cloud.push_back(point);
  return cloud;
}

std::vector<double> times(const Cloud& cloud) {
  std::vector<double> all;
  for (const auto& point : cloud) all.push_back(point.time);
  return all;
}

OptionValue list(std::initializer_list<double> values) {
  return std::vector<OptionScalar>(values.begin(), values.end());
}

TEST(Voxel, TheFirstPointOfACellStaysWholeOverAllClouds) {
  auto stage = StageDriver::of<VoxelStage>({{"size", OptionScalar(0.1)}});
  auto first = point_at(0.01F, 0.01F, 0.01F, 1.25);
  first.laser = 2;
  first.beam = 77;
  first.intensity = 9;
  stage.feed(cloud_of({first, point_at(0.09F, 0.09F, 0.09F, 2), point_at(0.11F, 0, 0, 3)}));
  stage.feed(cloud_of({point_at(0.05F, 0.05F, 0.05F, 4), point_at(-0.01F, 0, 0, 5)}));
  const auto clouds = stage.given<Cloud>();
  EXPECT_THAT(times(*clouds.at(0)), ElementsAre(1.25, 3));
  EXPECT_THAT(times(*clouds.at(1)), ElementsAre(5)) << "the cells on either side of 0 are two";
  EXPECT_EQ(clouds[0]->at(0).laser, 2);
  EXPECT_EQ(clouds[0]->at(0).beam, 77);
  EXPECT_EQ(clouds[0]->at(0).intensity, 9);
  EXPECT_EQ(stage.report().counts.at("points in occupied cells"), 2U);
}

TEST(Voxel, KeepsOnePointInEachCellOfADenseCube) {
  Voxels voxels(1);
  int kept = 0;
  for (int i = 0; i < 40 * 40 * 40; ++i) {
    const auto coordinate = [](int step) { return (static_cast<float>(step) + 0.5F) / 10 - 2; };
    const auto found = voxels.put(coordinate(i % 40), coordinate(i / 40 % 40), coordinate(i / 1600));
    kept += found == InVoxel::first ? 1 : 0;
  }
  EXPECT_EQ(kept, 4 * 4 * 4);
}

TEST(Voxel, PointsThatHaveNoCellAreNotKept) {
  Voxels voxels(1e-4);
  EXPECT_EQ(voxels.put(0, kNan, 0), InVoxel::nowhere);
  EXPECT_EQ(voxels.put(0, std::numeric_limits<float>::infinity(), 0), InVoxel::too_far);
  EXPECT_EQ(voxels.put(0, 0, -3e5F), InVoxel::too_far);
  EXPECT_EQ(voxels.put(0, 0, -2e5F), InVoxel::first);
}

TEST(Voxel, PointsBeyondTheGridAreALossOfTheirOwnAndWarnedOf) {
  auto stage = StageDriver::of<VoxelStage>({{"size", OptionScalar(1e-3)}});
  stage.feed(cloud_of({point_at(0, 0, 1, 1), point_at(0, 0, 1, 2), point_at(0, 5e9F, 0, 3)}));
  stage.feed(cloud_of({point_at(1e30F, 0, 1, 4), point_at(0, 0, 2, 5), point_at(kNan, 0, 1, 6)}));
  stage.finish();
  EXPECT_EQ(stage.report().counts.at("points with a coordinate that is no number"), 1U);
  EXPECT_EQ(stage.report().counts.at("points in occupied cells"), 1U);
  EXPECT_EQ(stage.report().counts.at("points outside of the grid"), 2U);
  ASSERT_EQ(stage.report().warnings.size(), 1U);
  EXPECT_THAT(stage.report().warnings[0], testing::HasSubstr("2 points are dropped that are 2.15e+03 km"));
}

TEST(Voxel, ThePclFilterRefusesAnEdgeThatIsNoLengthAndCountsWhatHasNoVoxel) {
  FirstInVoxel<pcl::PointXYZ> filter;
  for (const double size :
       {0.0, -0.05, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(filter.setLeafSize(size), Error) << size;
  }
  EXPECT_EQ(filter.getLeafSize(), 0.05) << "what was refused changes nothing";
  const auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const float x : {0.1F, 1e30F, 0.2F}) cloud->push_back({x, 0, 0});
  filter.setInputCloud(cloud);
  pcl::PointCloud<pcl::PointXYZ> thinned;
  filter.filter(thinned);
  EXPECT_EQ(thinned.size(), 2U);
  EXPECT_EQ(filter.getTooFar(), 1U);
}

TEST(Voxel, ThePclFilterThinsAnyCloudAndHeedsItsIndices) {
  const auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const float x : {0.1F, 0.2F, 1.1F, 2.1F}) cloud->push_back({x, 0, 0});
  FirstInVoxel<pcl::PointXYZ> filter;
  filter.setLeafSize(1);
  filter.setInputCloud(cloud);
  filter.setIndices(std::make_shared<pcl::Indices>(pcl::Indices{1, 2}));
  pcl::PointCloud<pcl::PointXYZ> thinned;
  filter.filter(thinned);
  ASSERT_EQ(thinned.size(), 2U);
  EXPECT_EQ(thinned[0].x, 0.2F);
  EXPECT_EQ(thinned[1].x, 1.1F);
}

TEST(Crop, KeepsWhatIsWithinAllLimitsThemselvesIncluded) {
  auto stage = StageDriver::of<CropStage>({{"z", list({-1, 2})}, {"distance", list({0.5, 5})}});
  stage.feed(
      cloud_of({point_at(0, 0, 2, 1), point_at(0, 0, 2.1F, 2), point_at(0, 0, -1, 3), point_at(0.1F, 0, 0, 4),
                point_at(3, 4, 0, 5), point_at(3, 4, 1, 6), point_at(kNan, 0, 0, 7)}));
  EXPECT_THAT(times(*stage.given<Cloud>().at(0)), ElementsAre(1, 3, 5));
  EXPECT_EQ(stage.report().counts.at("points outside the limits"), 4U);
}

TEST(Crop, LimitsInTheWrongOrderOrAloneAreRefused) {
  EXPECT_THROW(StageDriver::of<CropStage>({{"y", list({2})}}).check(), Error);
  EXPECT_THROW(StageDriver::of<CropStage>({{"x", list({2, 1})}}).check(), Error);
  EXPECT_NO_THROW(StageDriver::of<CropStage>({{"x", list({1, 1})}}).check());
}

Measurements three_measurements() {
  return {.epoch_ns = 5,
          .range = {0.1F, 2, 3},
          .mirror_angle = {0, 0.5F, -1},
          .time = {1, 2, 3},
          .laser = {0, 1, 2},
          .remission = {10, 20, 30},
          .beam = {7, 8, 9}};
}

TEST(Range, KeepsMeasurementsWholeWithinTheLimits) {
  auto stage = StageDriver::of<RangeStage>({{"range", list({0.5, 10})}, {"mirror_angle", list({-0.9, 0.9})}});
  stage.feed(three_measurements());
  const auto kept = stage.given<Measurements>().at(0);
  EXPECT_EQ(kept->epoch_ns, 5);
  EXPECT_THAT(kept->range, ElementsAre(2));
  EXPECT_THAT(kept->mirror_angle, ElementsAre(0.5F));
  EXPECT_THAT(kept->time, ElementsAre(2));
  EXPECT_THAT(kept->laser, ElementsAre(1));
  EXPECT_THAT(kept->remission, ElementsAre(20));
  EXPECT_THAT(kept->beam, ElementsAre(8));
  stage.finish();
  EXPECT_THAT(stage.report().lines, ElementsAre("kept 1 of 3 measurements"));
}

TEST(Range, KeepsMeasurementsWithinLimitsOfTheRemission) {
  auto stage = StageDriver::of<RangeStage>({{"remission", list({15, 30})}});
  stage.feed(three_measurements());
  EXPECT_THAT(stage.given<Measurements>().at(0)->remission, ElementsAre(20, 30));
}

TEST(Range, KeepsTheLasersThatAreNamed) {
  const OptionValue names = std::vector<OptionScalar>{std::string("laser3"), std::string("laser1")};
  auto stage = StageDriver::of<RangeStage>({{"lasers", names}});
  stage.feed(three_measurements());
  EXPECT_THAT(stage.given<Measurements>().at(0)->laser, ElementsAre(0, 2));
}

TEST(Range, ALaserThatTheRigDoesNotHaveIsRefusedWithTheOneThatWasMeant) {
  const OptionValue names = std::vector<OptionScalar>{std::string("lasr1")};
  try {
    StageDriver::of<RangeStage>({{"lasers", names}}).check();
    FAIL() << "took a laser that is not there";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'laser1'?"));
  }
}

}  // namespace
}  // namespace crisp
