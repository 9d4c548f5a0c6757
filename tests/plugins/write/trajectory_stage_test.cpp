// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/trajectory_stage.hpp"

#include <gmock/gmock.h>

#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::write;

class WriteTrajectory : public testing::Test {
 protected:
  WriteTrajectory()
      : stage_(test::StageDriver::of<WriteTrajectoryStage>(
            {{"file", OptionScalar((folder_ / "t.csv").string())}})) {}
  test::TemporaryFolder folder_;
  test::StageDriver stage_;
};

TEST_F(WriteTrajectory, HasARowForEachReadingWithItsInstantToTheNanosecond) {
  stage_.feed(PlateTrajectory(1'700'000'000'000'000'001, {0, 0.5, 1}, {0, 1, 2}, 10));
  stage_.feed(PlateTrajectory(1'700'000'000'000'000'001, {100, 101}, {7, 7}, 10));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "t.csv"));
  stage_.finish();
  EXPECT_EQ(test::bytes_of(folder_ / "t.csv"),
            "time,angle,rate\n1700000000.000000001,0,2\n1700000000.500000001,1,2\n1700000001.000000001,2,2\n"
            "1700000100.000000001,7,0\n1700000101.000000001,7,0\n");
  EXPECT_EQ(stage_.report().section.at("readings"), 5);
}

TEST_F(WriteTrajectory, WithoutReadingsIsAnErrorAndNoFile) {
  EXPECT_THROW(stage_.finish(), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace crisp
