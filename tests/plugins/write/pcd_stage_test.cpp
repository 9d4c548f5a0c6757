// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/pcd_stage.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>

#include <crisp/cloud_conversion.hpp>

#include "tests/pipeline/pcd/sample_tables.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::pcd;
using namespace crisp::write;
namespace fs = std::filesystem;
using test::sample_cloud;
using test::StageDriver;
using testing::ElementsAre;

class WritePcd : public testing::Test {
 protected:
  StageDriver writer(std::map<std::string, OptionValue> options = {}) const {
    options.emplace("file", OptionScalar((folder_ / "cloud.pcd").string()));
    return StageDriver::of<WritePcdStage>(options);
  }
  std::vector<Cloud> read(std::string_view name) const {
    std::vector<Cloud> clouds;
    read_parts(folder_ / name,
               [&](const PcdTable& table, const fs::path&) { clouds.push_back(*cloud_of(table).cloud); });
    return clouds;
  }
  test::TemporaryFolder folder_;
};

std::vector<double> times(const Cloud& cloud) {
  std::vector<double> all;
  for (const auto& point : cloud) all.push_back(point.time);
  return all;
}

Cloud cloud_of_times(std::initializer_list<double> times) {
  Cloud cloud;
  for (const double time : times) {
    Point point;
    point.time = time;
    cloud.push_back(point);
  }
  return cloud;
}

TEST_F(WritePcd, WhatComesAfterAPauseIsInAFileOfItsOwn) {
  auto stage = writer();
  stage.feed(cloud_of_times({0, 2, 1}));
  stage.feed(cloud_of_times({5, 4}));
  stage.feed(cloud_of_times({30}));
  stage.finish();
  const auto clouds = read("cloud.pcd");
  ASSERT_EQ(clouds.size(), 2U);
  EXPECT_THAT(times(clouds[0]), ElementsAre(0, 2, 1, 5, 4));
  EXPECT_THAT(times(clouds[1]), ElementsAre(30));
}

TEST_F(WritePcd, PointsInAnyOrderOfTimeAreOneRecording) {
  auto stage = writer();
  stage.feed(cloud_of_times({0, 50, 20, 60, 10}));
  stage.finish();
  EXPECT_EQ(read("cloud.pcd").size(), 1U);
}

PlateTrajectory turning_at(const std::vector<double>& times) {
  std::vector<double> angles;
  for (const double time : times) angles.push_back(0.01 * time);
  return {0, times, angles, 0.1};
}

TEST_F(WritePcd, APauseIsOneOfThePlateWhereThereIsOne) {
  auto stage = writer();
  stage.feed(turning_at({0, 1, 2, 3, 4, 8, 12, 16, 20, 30, 31}));
  stage.feed(turning_at({31.5, 35}));
  stage.feed(cloud_of_times({0, 1, 19, 20}));  // whom a filter took what was between
  stage.feed(cloud_of_times({30, 31}));
  stage.feed(turning_at({50, 51}));
  stage.feed(cloud_of_times({35}));
  stage.feed(cloud_of_times({51}));
  stage.finish();
  const auto clouds = read("cloud.pcd");
  ASSERT_EQ(clouds.size(), 3U);
  EXPECT_THAT(times(clouds[0]), ElementsAre(0, 1, 19, 20));
  EXPECT_THAT(times(clouds[1]), ElementsAre(30, 31, 35));
  EXPECT_THAT(times(clouds[2]), ElementsAre(51));
}

TEST_F(WritePcd, CloudsThatComeInPiecesBecomeOneFile) {
  auto stage = writer();
  stage.feed(sample_cloud(10));
  stage.feed(sample_cloud(5));
  EXPECT_TRUE(fs::is_empty(folder_.path())) << "nothing is to be seen of a cloud that is not complete";
  stage.finish();
  const auto clouds = read("cloud.pcd");
  ASSERT_EQ(clouds.size(), 1U);
  EXPECT_EQ(clouds[0].size(), 15U);
  EXPECT_EQ(clouds[0].header.stamp, sample_cloud(1).header.stamp);
  EXPECT_EQ(clouds[0][14].time, sample_cloud(5)[4].time);
  EXPECT_THAT(stage.report().written, ElementsAre(folder_ / "cloud.pcd"));
  EXPECT_EQ(stage.report().section.at("points"), 15);
}

TEST_F(WritePcd, ALongCloudIsSplitByPoints) {
  auto stage = writer({{"split_points", OptionScalar(std::int64_t{4})}});
  stage.feed(sample_cloud(9));
  stage.finish();
  std::vector<std::size_t> sizes;
  for (const auto& cloud : read("cloud.pcd")) sizes.push_back(cloud.size());
  EXPECT_THAT(sizes, ElementsAre(4, 4, 1));
  EXPECT_EQ(stage.report().written.size(), 3U);
}

TEST_F(WritePcd, ACloudOfExactlyTheMostPointsIsOneFile) {
  auto stage = writer({{"split_points", OptionScalar(std::int64_t{9})}});
  stage.feed(sample_cloud(9));
  stage.finish();
  EXPECT_TRUE(fs::exists(folder_ / "cloud.pcd"));
}

TEST_F(WritePcd, ALongCloudIsSplitByTime) {
  auto stage = writer({{"split_duration", OptionScalar(2.0)}});
  stage.feed(cloud_of_times({0, 1, 1.9, 2.0, 3.5}));
  stage.feed(cloud_of_times({4.5}));
  stage.finish();
  const auto clouds = read("cloud.pcd");
  ASSERT_EQ(clouds.size(), 3U);
  EXPECT_THAT(times(clouds[0]), ElementsAre(0, 1, 1.9));
  EXPECT_THAT(times(clouds[1]), ElementsAre(2.0, 3.5));
  EXPECT_THAT(times(clouds[2]), ElementsAre(4.5));
}

TEST_F(WritePcd, CloudsOfDifferentEpochsKeepTheirInstants) {
  auto stage = writer();
  Cloud first = cloud_of_times({0.5});
  Cloud second = cloud_of_times({0.5});
  first.header.stamp = 1'700'000'000'000'000;
  second.header.stamp = 1'700'000'003'000'000;
  stage.feed(first);
  stage.feed(second);
  stage.finish();
  EXPECT_THAT(times(read("cloud.pcd").at(0)), ElementsAre(0.5, 3.5));
}

TEST_F(WritePcd, PointsThatAreNotNumbersAreCounted) {
  auto stage = writer();
  Cloud cloud = sample_cloud(3);
  cloud[1].y = std::numeric_limits<float>::quiet_NaN();
  stage.feed(cloud);
  stage.finish();
  EXPECT_EQ(read("cloud.pcd").at(0).size(), 2U);
  EXPECT_EQ(stage.report().counts.at("points with coordinates that are no numbers"), 1U);
}

TEST_F(WritePcd, NoPointsAreAnErrorAndNoFile) {
  auto stage = writer();
  stage.feed(Cloud());
  EXPECT_THROW(stage.finish(), Error);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(WritePcd, AFullDiskIsAnErrorThatNamesTheFileAndLeavesNothing) {
  const rlimit before = [] {
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    return limit;
  }();
  const rlimit small{.rlim_cur = 1000, .rlim_max = before.rlim_max};
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  auto stage = writer({{"format", OptionScalar(std::string("ascii"))}});
  stage.feed(sample_cloud(1000));
  std::string complaint;
  try {
    stage.finish();
  } catch (const Error& error) {
    complaint = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  static_cast<void>(std::signal(SIGXFSZ, handler));
  EXPECT_THAT(complaint, testing::HasSubstr("cloud.pcd: File too large; make room"));
}

TEST_F(WritePcd, AFolderThatCannotBeIsAnErrorBeforeTheEnd) {
  test::put_bytes(folder_ / "file", "");
  auto stage =
      StageDriver::of<WritePcdStage>({{"file", OptionScalar((folder_ / "file/cloud.pcd").string())}});
  stage.feed(sample_cloud(1));
  EXPECT_THROW(stage.finish(), Error);
}

}  // namespace
}  // namespace crisp
