// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <fstream>

#include "plugins/write/picture_stage.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

Cloud cloud_of(const std::vector<std::array<float, 3>>& points, std::uint16_t laser = 0) {
  Cloud cloud;
  for (const auto& [x, y, z] : points) {
    Point point;
    point.x = x;
    point.y = y;
    point.z = z;
    point.laser = laser;
    cloud.push_back(point);
  }
  return cloud;
}

/// Ten by ten pixels of 1 m.
PictureSettings chessboard() { return {.across = 10, .width = 10, .height = 10}; }

/// Rows and columns of the pixels that are not black.
std::vector<std::pair<int, int>> lit(const Picture& picture) {
  std::vector<std::pair<int, int>> found;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    const int pixel = static_cast<int>(i / 3);
    if (picture.rgb[i] + picture.rgb[i + 1] + picture.rgb[i + 2] > 0)
      found.emplace_back(pixel / 10, pixel % 10);
  }
  return found;
}

using Pixels = std::vector<std::pair<int, int>>;

TEST(Picture, ShowsXToTheRightAndYUpwardsFromTheTop) {
  PicturePainter painter(chessboard());
  EXPECT_EQ(painter.add(cloud_of({{3.5F, 4.5F, 0}, {100, 0, 0}})), 1U);
  EXPECT_EQ(lit(painter.picture()), (Pixels{{0, 8}}));
}

TEST(Picture, ShowsZUpwardsFromTheFrontAndTheSide) {
  auto settings = chessboard();
  settings.view = PictureView::front;
  PicturePainter front(settings);
  front.add(cloud_of({{-4.5F, 2, 1.5F}}));
  EXPECT_EQ(lit(front.picture()), (Pixels{{3, 0}}));
  settings.view = PictureView::side;
  PicturePainter side(settings);
  side.add(cloud_of({{-4.5F, 2.5F, 1.5F}}));
  EXPECT_EQ(lit(side.picture()), (Pixels{{3, 7}}));
}

TEST(Picture, LeavesOutWhatIsTooNearOrTooFar) {
  auto settings = chessboard();
  settings.depth = {0, 1};
  PicturePainter painter(settings);
  EXPECT_EQ(painter.add(cloud_of({{0.5F, 0.5F, 0.5F}, {1.5F, 0.5F, 2}, {2.5F, 0.5F, -1}})), 1U);
}

TEST(Picture, IsAPngThatHoldsWhatWasDrawn) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "picture.png";
  auto driver = test::StageDriver::of<WritePictureStage>(
      {{"file", OptionScalar(file.string())}, {"width", OptionScalar(std::int64_t{20})}});
  driver.feed(cloud_of({{0.1F, 0.1F, 0}}, 1));
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

TEST(Picture, ThatWouldBeEmptyIsNotWritten) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "picture.png";
  write_file(file, "of an earlier run");
  write_file(file.string() + ".provenance.json", "{}");
  auto driver = test::StageDriver::of<WritePictureStage>({{"file", OptionScalar(file.string())}});
  driver.feed(cloud_of({{1000, 0, 0}}, 1));
  driver.finish();
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nor is one left that shows something else";
  EXPECT_TRUE(driver.report().written.empty());
  EXPECT_THAT(driver.report().warnings, testing::ElementsAre(testing::HasSubstr("no point is in")));
}

TEST(Picture, OfNothingIsAnError) {
  auto driver = test::StageDriver::of<WritePictureStage>({{"file", OptionScalar(std::string("x.png"))}});
  EXPECT_THROW(driver.finish(), Error);
}

}  // namespace
}  // namespace crisp
