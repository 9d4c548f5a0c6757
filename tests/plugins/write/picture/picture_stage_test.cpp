// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/picture_stage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <fstream>

#include <crisp/atomic_file.hpp>

#include "tests/plugins/write/picture/support.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::write;

TEST(PictureStage, WritesAPngOfTheSizeAskedFor) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "picture.png";
  auto driver = test::StageDriver::of<WritePictureStage>(
      {{"file", OptionScalar(file.string())}, {"width", OptionScalar(std::int64_t{20})}});
  driver.feed(test::picture_cloud({{0.1F, 0.1F, 0}}, 1));
  driver.finish();
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(image.width, 20U);
  EXPECT_EQ(image.height, 600U);
  png_image_free(&image);
  EXPECT_EQ(driver.report().written.size(), 1U);
}

TEST(PictureStage, WritesNoEmptyPictureAndRemovesAnEarlierOne) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "picture.png";
  write_file(file, "of an earlier run");
  write_file(file.string() + ".provenance.json", "{}");
  auto driver = test::StageDriver::of<WritePictureStage>(
      {{"file", OptionScalar(file.string())},
       {"depth", std::vector<OptionScalar>{OptionScalar(1.0), OptionScalar(2.0)}}});
  driver.feed(test::picture_cloud({{1000, 0, 0}}, 1));
  driver.finish();
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nor is one left that shows something else";
  EXPECT_TRUE(driver.report().written.empty());
  EXPECT_THAT(driver.report().warnings, testing::ElementsAre(testing::HasSubstr("no point is in")));
}

TEST(PictureStage, WithoutACloudIsAnError) {
  auto driver = test::StageDriver::of<WritePictureStage>({{"file", OptionScalar(std::string("x.png"))}});
  EXPECT_THROW(driver.finish(), Error);
}

}  // namespace
}  // namespace crisp
