// SPDX-License-Identifier: BSD-3-Clause
// PCL is the judge: what crisp writes PCL reads, and the reverse, field for field.
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <crisp/cloud_conversion.hpp>

#include "tests/pipeline/pcd/sample_tables.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using test::sample_cloud;
using test::TemporaryFolder;

class AgainstPcl : public testing::TestWithParam<PcdFormat> {
 protected:
  std::filesystem::path file() const { return folder_ / "cloud.pcd"; }

  void write(const Cloud& cloud) const {
    AtomicFile out(file());
    write_pcd(out, to_pcd_table(cloud), GetParam());
    out.commit();
  }

 private:
  TemporaryFolder folder_;
};

void expect_same_points(const Cloud& actual, const Cloud& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(actual[i].x, expected[i].x);
    ASSERT_EQ(actual[i].y, expected[i].y);
    ASSERT_EQ(actual[i].z, expected[i].z);
    ASSERT_EQ(actual[i].intensity, expected[i].intensity);
    ASSERT_EQ(actual[i].laser, expected[i].laser);
    ASSERT_EQ(actual[i].beam, expected[i].beam);
    ASSERT_EQ(actual[i].time, expected[i].time);
  }
}

TEST_P(AgainstPcl, ReadsEveryFieldThatCrispWrote) {
  const Cloud written = sample_cloud(1000);
  write(written);
  Cloud read;
  ASSERT_EQ(pcl::io::loadPCDFile(file().string(), read), 0);
  expect_same_points(read, written);
}

TEST_P(AgainstPcl, ReadsOnePointAndNone) {
  for (const std::size_t n : {1, 0}) {
    write(sample_cloud(n));
    pcl::PCLPointCloud2 read;  // not a Cloud: to make one of no points, PCL takes the address of the first
    EXPECT_EQ(pcl::io::loadPCDFile(file().string(), read), 0);
    EXPECT_EQ(read.width * read.height, n);
    EXPECT_EQ(cloud_of(read_pcd(file())).cloud->size(), n);
  }
}

TEST_P(AgainstPcl, IsReadFieldForField) {
  const Cloud written = sample_cloud(1000);
  pcl::PCDWriter writer;
  const std::string name = file().string();
  if (GetParam() == PcdFormat::ascii) {
    constexpr int kDigits = 17;
    pcl::PCLPointCloud2 points;
    pcl::toPCLPointCloud2(written, points);
    ASSERT_EQ(
        writer.writeASCII(name, points, Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity(), kDigits), 0);
  } else if (GetParam() == PcdFormat::binary) {
    pcl::PCLPointCloud2 padded;  // with the gaps of a point in memory as fields of the name "_"
    pcl::toPCLPointCloud2(written, padded);
    ASSERT_EQ(writer.writeBinary(name, padded), 0);
  } else {
    ASSERT_EQ(writer.writeBinaryCompressed(name, written), 0);
  }
  const auto read = cloud_of(read_pcd(file()));
  expect_same_points(*read.cloud, written);
  EXPECT_EQ(read.not_finite, 0U);
}

TEST_P(AgainstPcl, TheEpochStaysWithTheCloud) {
  write(sample_cloud(3));
  EXPECT_EQ(cloud_of(read_pcd(file())).cloud->header.stamp, 1'700'000'000'123'456U);
}

INSTANTIATE_TEST_SUITE_P(Formats, AgainstPcl,
                         testing::Values(PcdFormat::ascii, PcdFormat::binary, PcdFormat::binary_compressed));

}  // namespace
}  // namespace crisp
