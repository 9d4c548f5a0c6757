// SPDX-License-Identifier: BSD-3-Clause
// PLY files are read by PCL, LAS files by a reader written from the ASPRS' specification: Debian 12 has no
// other.
#include "plugins/write/cloud_file_stage.hpp"

#include <gmock/gmock.h>
#include <pcl/io/ply_io.h>

#include "plugins/write/las_writer.hpp"
#include "plugins/write/ply_writer.hpp"
#include "tests/plugins/write/las_reader.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::write;
namespace fs = std::filesystem;
using test::StageDriver;
using testing::ElementsAre;
using testing::HasSubstr;

/// 2023-11-14 22:13:20.123456 UTC; GPS time was 18 s ahead.
constexpr std::uint64_t kStamp = 1'700'000'000'123'456;

Cloud room(std::size_t n) {
  Cloud cloud;
  cloud.header.stamp = kStamp;
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<float>(i);
    Point point;
    point.x = 20.0F * std::sin(k);
    point.y = -1.0F / (k + 3);
    point.z = 1e-3F * k;
    point.intensity = static_cast<float>(i % 1024);
    point.laser = static_cast<std::uint16_t>(i % 3);
    point.beam = static_cast<std::uint16_t>(i % 541);
    point.time = static_cast<double>(i) * 1.234567890123e-5;
    cloud.push_back(point);
  }
  return cloud;
}

template <class Writer>
class WriteCloudFile : public testing::Test {
 protected:
  fs::path file() const { return folder_ / (std::string("cloud") + Writer::kEnding); }
  StageDriver writer() const {
    return StageDriver::of<CloudFileStage<Writer>>({{"file", OptionScalar(file().string())}});
  }
  test::TemporaryFolder folder_;
};

using Writers = testing::Types<LasWriter, PlyWriter>;
TYPED_TEST_SUITE(WriteCloudFile, Writers);

TYPED_TEST(WriteCloudFile, NoPointsAreAnErrorAndNoFile) {
  auto stage = this->writer();
  stage.feed(Cloud());
  EXPECT_THROW(stage.finish(), Error);
  EXPECT_TRUE(fs::is_empty(this->folder_.path()));
}

TYPED_TEST(WriteCloudFile, AppearsWhenItIsComplete) {
  auto stage = this->writer();
  stage.feed(room(10));
  EXPECT_FALSE(fs::exists(this->file()));
  stage.finish();
  EXPECT_TRUE(fs::exists(this->file()));
  EXPECT_THAT(stage.report().written, ElementsAre(this->file()));
  EXPECT_EQ(stage.report().section.at("points"), 10);
}

TYPED_TEST(WriteCloudFile, APauseIsWarnedOf) {
  auto stage = this->writer();
  Cloud later = room(2);
  later.header.stamp += 60'000'000;
  stage.feed(room(2));
  stage.feed(later);
  stage.finish();
  ASSERT_EQ(stage.report().warnings.size(), 1U);
  EXPECT_THAT(stage.report().warnings[0], HasSubstr("2 recordings"));
}

class WritePly : public WriteCloudFile<PlyWriter> {
 protected:
  pcl::PCLPointCloud2 read() const {
    pcl::PCLPointCloud2 read;
    EXPECT_EQ(pcl::io::loadPLYFile(file().string(), read), 0);
    return read;
  }
};

template <class T>
std::vector<T> column(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  std::vector<T> values;
  for (const auto& field : cloud.fields) {
    if (field.name != name) continue;
    for (std::size_t i = 0; i < std::size_t{cloud.width} * cloud.height; ++i) {
      T value;
      std::memcpy(&value, cloud.data.data() + i * cloud.point_step + field.offset, sizeof(T));
      values.push_back(value);
    }
  }
  return values;
}

template <class T, class Member>
std::vector<T> expected(const Cloud& cloud, Member member) {
  std::vector<T> values;
  for (const auto& point : cloud) values.push_back(std::invoke(member, point));
  return values;
}

TEST_F(WritePly, GivesPclEveryNumberExactly) {
  const Cloud cloud = room(20'000);
  auto stage = writer();
  stage.feed(cloud);
  stage.finish();
  const auto read_back = read();
  EXPECT_EQ(column<float>(read_back, "x"), expected<float>(cloud, [](const Point& p) { return p.x; }));
  EXPECT_EQ(column<float>(read_back, "y"), expected<float>(cloud, [](const Point& p) { return p.y; }));
  EXPECT_EQ(column<float>(read_back, "z"), expected<float>(cloud, [](const Point& p) { return p.z; }));
  EXPECT_EQ(column<float>(read_back, "intensity"), expected<float>(cloud, &Point::intensity));
  EXPECT_EQ(column<std::uint16_t>(read_back, "laser"), expected<std::uint16_t>(cloud, &Point::laser));
  EXPECT_EQ(column<std::uint16_t>(read_back, "beam"), expected<std::uint16_t>(cloud, &Point::beam));
  EXPECT_EQ(column<double>(read_back, "time"), expected<double>(cloud, &Point::time));
}

TEST_F(WritePly, ReportsTheEpochInAComment) {
  auto stage = writer();
  stage.feed(room(1));
  stage.finish();
  EXPECT_THAT(test::bytes_of(file()), HasSubstr("\ncomment crisp epoch_ns 1700000000123456000\n"));
}

TEST_F(WritePly, LeavesOutPointsThatAreNotNumbers) {
  Cloud cloud = room(3);
  cloud[1].z = std::numeric_limits<float>::quiet_NaN();
  auto stage = writer();
  stage.feed(cloud);
  stage.finish();
  EXPECT_THAT(column<float>(read(), "x"), ElementsAre(cloud[0].x, cloud[2].x));
  EXPECT_EQ(stage.report().counts.at("points with coordinates that are no numbers"), 1U);
}

class WriteLas : public WriteCloudFile<LasWriter> {
 protected:
  test::LasFile written(const Cloud& cloud) {
    auto stage = writer();
    stage.feed(cloud);
    stage.finish();
    counts_ = stage.report().counts;
    warnings_ = stage.report().warnings;
    return test::read_las(file());
  }
  std::map<std::string, std::uint64_t> counts_;
  std::vector<std::string> warnings_;
};

TEST_F(WriteLas, KeepsCoordinatesToHalfATenthOfAMillimetre) {
  const Cloud cloud = room(20'000);
  const auto las = written(cloud);
  ASSERT_EQ(las.points.size(), cloud.size());
  constexpr double kHalfAStep = 0.5e-4 + 1e-12;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_NEAR(las.points[i].x, cloud[i].x, kHalfAStep);
    ASSERT_NEAR(las.points[i].y, cloud[i].y, kHalfAStep);
    ASSERT_NEAR(las.points[i].z, cloud[i].z, kHalfAStep);
    ASSERT_EQ(las.points[i].intensity, cloud[i].intensity);
    ASSERT_EQ(las.points[i].extra.at("laser"), cloud[i].laser);
    ASSERT_EQ(las.points[i].extra.at("beam"), cloud[i].beam);
    ASSERT_EQ(las.points[i].point_source, 1);
    ASSERT_EQ(las.points[i].return_number, 1);
    ASSERT_EQ(las.points[i].returns, 1);
  }
}

TEST_F(WriteLas, HasTheExtentOfItsPoints) {
  Cloud cloud = room(2);
  cloud[0].x = -1.5F;
  cloud[0].y = 7;
  cloud[0].z = 0;
  cloud[1].x = 2;
  cloud[1].y = -3;
  cloud[1].z = 0.25F;
  const auto las = written(cloud);
  EXPECT_THAT(las.least, ElementsAre(testing::DoubleNear(-1.5, 1e-9), testing::DoubleNear(-3, 1e-9),
                                     testing::DoubleNear(0, 1e-9)));
  EXPECT_THAT(las.most, ElementsAre(testing::DoubleNear(2, 1e-9), testing::DoubleNear(7, 1e-9),
                                    testing::DoubleNear(0.25, 1e-9)));
}

TEST_F(WriteLas, CountsTimeAsGpsDoes) {
  const auto las = written(room(2));
  EXPECT_TRUE(las.has_standard_gps_time);
  // 1 700 000 000 - 315 964 800 (1980-01-06) + 18 leap seconds - 10^9
  EXPECT_NEAR(las.points[0].gps_time, 384'035'218.123456, 1e-7);
  EXPECT_NEAR(las.points[1].gps_time, 384'035'218.123456 + 1.2345679e-5, 1e-7);
}

TEST_F(WriteLas, CountsTimeFromTheEpochWhereTheCloudHasNoDate) {
  Cloud cloud = room(2);
  cloud.header.stamp = 0;
  const auto las = written(cloud);
  EXPECT_FALSE(las.has_standard_gps_time);
  EXPECT_EQ(las.points[1].gps_time, cloud[1].time);
}

TEST_F(WriteLas, MovesItsOffsetToAMapsGrid) {
  Cloud cloud = room(2);
  cloud[0].x = 500'000;
  cloud[0].y = 5'500'000.5F;
  cloud[1].x = 500'100.25F;
  cloud[1].y = 5'500'000.5F;
  const auto las = written(cloud);
  EXPECT_NEAR(las.points[1].x, 500'100.25, 1e-4);
  EXPECT_NEAR(las.points[1].y, 5'500'000.5, 1e-4);
}

TEST_F(WriteLas, MovesItsOffsetToTheMiddleOfAWideCloud) {
  Cloud cloud = room(20'000);  // more than a buffer
  cloud[19'998].x = 3e5F;
  const auto las = written(cloud);
  ASSERT_EQ(las.points.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_NEAR(las.points[i].x, cloud[i].x, 0.51e-4);
    ASSERT_NEAR(las.points[i].z, cloud[i].z, 0.51e-4);
    ASSERT_EQ(las.points[i].extra.at("beam"), cloud[i].beam);
  }
  EXPECT_NEAR(las.most[0], 3e5, 1e-4);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(WriteLas, RoundsTheCoordinatesOfAWiderCloudMoreCoarselyAndWarns) {
  Cloud cloud = room(20'000);
  cloud[9'000].x = 1e6F;
  cloud[9'001].y = -1e7F;
  const auto las = written(cloud);
  ASSERT_EQ(las.points.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_NEAR(las.points[i].x, cloud[i].x, 0.0056);
    ASSERT_NEAR(las.points[i].y, cloud[i].y, 0.0056);
  }
  EXPECT_NEAR(las.least[1], -1e7, 0.01);
  EXPECT_THAT(warnings_, ElementsAre(testing::HasSubstr("in steps of 10 mm instead of 0.1 mm")));
}

TEST_F(WriteLas, CountsPointsThatItCannotHold) {
  Cloud cloud = room(3);
  cloud[1].x = 4e9F;
  const auto las = written(cloud);
  EXPECT_EQ(las.points.size(), 2U);
  EXPECT_EQ(counts_.at("points too far from the others for LAS"), 1U);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(WriteLas, CountsIntensitiesThatItRounds) {
  Cloud cloud = room(4);
  cloud[0].intensity = 0.4F;
  cloud[1].intensity = -1;
  cloud[2].intensity = 70'000;
  cloud[3].intensity = 65'535;
  const auto las = written(cloud);
  EXPECT_EQ(las.points[0].intensity, 0);
  EXPECT_EQ(las.points[1].intensity, 0);
  EXPECT_EQ(las.points[2].intensity, 65'535);
  EXPECT_EQ(las.points[3].intensity, 65'535);
  EXPECT_EQ(counts_.at("intensities that LAS rounded or limited to 0 to 65535"), 3U);
}

TEST_F(WriteLas, NumbersRecordingsAsPointSources) {
  auto stage = writer();
  Cloud later = room(1);
  later.header.stamp += 60'000'000;
  stage.feed(room(1));
  stage.feed(later);
  stage.finish();
  const auto las = test::read_las(file());
  EXPECT_EQ(las.points.at(0).point_source, 1);
  EXPECT_EQ(las.points.at(1).point_source, 2);
  EXPECT_NEAR(las.points[1].gps_time - las.points[0].gps_time, 60, 1e-6);
}

}  // namespace
}  // namespace crisp
