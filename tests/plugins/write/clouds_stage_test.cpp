// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/clouds_stage.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include <crisp/cloud_conversion.hpp>

#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::write;
namespace fs = std::filesystem;

Cloud cloud_of(std::size_t points) {
  Cloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    Point point;
    point.x = static_cast<float>(i);
    cloud.push_back(point);
  }
  return cloud;
}

OptionValue text(const fs::path& path) { return OptionScalar(path.string()); }

TEST(WriteClouds, PutsEachCloudInAFileOfItsOwnSoon) {
  const test::TemporaryFolder folder;
  auto stage = test::StageDriver::of<WriteCloudsStage>({{"file", text(folder / "c.pcd")}});
  stage.feed(cloud_of(3));
  while (!fs::exists(folder / "c_0001.pcd")) std::this_thread::yield();
  EXPECT_EQ(cloud_of(read_pcd(folder / "c_0001.pcd")).cloud->size(), 3U) << "before the run ends";
  stage.feed(cloud_of(5));
  stage.finish();
  EXPECT_EQ(cloud_of(read_pcd(folder / "c_0002.pcd")).cloud->size(), 5U);
  EXPECT_THAT(stage.report().written, testing::ElementsAre(folder / "c_0001.pcd", folder / "c_0002.pcd"));
}

TEST(WriteClouds, KeepsTheRequestedNumberOfLastClouds) {
  const test::TemporaryFolder folder;
  auto stage = test::StageDriver::of<WriteCloudsStage>(
      {{"file", text(folder / "c.pcd")}, {"keep", OptionScalar(std::int64_t{2})}});
  for (std::size_t n = 1; n <= 5; ++n) stage.feed(cloud_of(n));
  stage.finish();
  EXPECT_FALSE(fs::exists(folder / "c_0003.pcd"));
  EXPECT_THAT(stage.report().written, testing::ElementsAre(folder / "c_0004.pcd", folder / "c_0005.pcd"));
}

TEST(WriteClouds, ThoseOfAnEarlierLongerRunAreRemovedWithTheirRecords) {
  const test::TemporaryFolder folder;
  const auto write = [&](int clouds) {
    auto stage = test::StageDriver::of<WriteCloudsStage>({{"file", text(folder / "c.pcd")}});
    for (int i = 0; i < clouds; ++i) stage.feed(cloud_of(1));
    stage.finish();
  };
  write(3);
  std::ofstream(folder / "c_0003.pcd.provenance.json") << "{}";
  std::ofstream(folder / "c_0004.pcd") << "of another program";
  write(2);
  EXPECT_TRUE(fs::exists(folder / "c_0002.pcd"));
  EXPECT_FALSE(fs::exists(folder / "c_0003.pcd"));
  EXPECT_FALSE(fs::exists(folder / "c_0003.pcd.provenance.json"));
  EXPECT_TRUE(fs::exists(folder / "c_0004.pcd"));
}

TEST(WriteClouds, EndsWithoutThePipelineWhereItCannotWrite) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "taken") << "a file, no folder";
  auto stage = test::StageDriver::of<WriteCloudsStage>({{"file", text(folder / "taken/c.pcd")}});
  stage.feed(cloud_of(1));
  stage.feed(cloud_of(1));
  stage.finish();
  EXPECT_EQ(stage.report().counts.at("lost clouds (not written)"), 2U);
  ASSERT_EQ(stage.report().caveats.size(), 1U);
  EXPECT_THAT(stage.report().caveats[0], testing::StartsWith("no more clouds were written: "));
}

}  // namespace
}  // namespace crisp
