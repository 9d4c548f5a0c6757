// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <pcl/point_types.h>

#include <limits>

#include <crisp/cloud.hpp>
#include <crisp/pcl_rqe.hpp>

#include "tests/pipeline/quality/clouds.hpp"

namespace crisp {
namespace {

template <class PointT>
std::shared_ptr<pcl::PointCloud<PointT>> as_pcl(const Vectors& cloud) {
  auto result = std::make_shared<pcl::PointCloud<PointT>>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    PointT point;
    point.x = static_cast<float>(cloud.x[i]);
    point.y = static_cast<float>(cloud.y[i]);
    point.z = static_cast<float>(cloud.z[i]);
    result->push_back(point);
  }
  return result;
}

// PCL's coordinates are single: a few metres to some 1e-7 m, of a sigma of 5 cm some 1e-5.
constexpr double kRounding = 1e-4;

template <class PointT>
class PclRqeOf : public testing::Test {};
using PointTypes = testing::Types<pcl::PointXYZ, pcl::PointXYZI, Point>;
TYPED_TEST_SUITE(PclRqeOf, PointTypes);

TYPED_TEST(PclRqeOf, ACloudIsThatOfItsPoints) {
  const auto cloud = test::room_corner(300, 1, 0.01, 1);
  PclRqe<TypeParam> adapter;
  adapter.setInputCloud(as_pcl<TypeParam>(cloud));
  adapter.setSigma(0.05);
  adapter.setGradient(true);
  const auto result = adapter.compute();
  const auto truth = rqe(cloud.view(), {}, {.sigma = 0.05});
  EXPECT_NEAR(result.value, truth.value, kRounding);
  EXPECT_NEAR(result.gradient.x[7], truth.gradient.x[7], kRounding / 0.05);
}

TEST(PclRqe, LeavesOutPointsThatAreNotFinite) {
  auto cloud = test::room_corner(300, 1, 0.01, 2);
  const auto input = as_pcl<pcl::PointXYZ>(cloud);
  (*input)[3].y = std::numeric_limits<float>::quiet_NaN();
  PclRqe<pcl::PointXYZ> adapter;
  adapter.setInputCloud(input);
  const double value = adapter.compute().value;
  EXPECT_EQ(adapter.getUsedIndices().size(), 299U);
  EXPECT_EQ(adapter.getUsedIndices()[3], 4);
  cloud.x[3] = 1e6;  // where it sees no other; it then counts in the mean over pairs
  const auto far = rqe(cloud.view(), {}, {});
  const double self = std::pow(4 * 3.14159265358979 * 0.03 * 0.03, -1.5);
  EXPECT_NEAR(std::exp(-value) * 299 * 299, far.energy * 300 * 300 - self, 1e-3 * self);
}

TEST(PclRqe, TakesOnlyThePointsThatAreNamed) {
  const auto cloud = test::room_corner(300, 1, 0.01, 3);
  PclRqe<pcl::PointXYZ> adapter;
  adapter.setInputCloud(as_pcl<pcl::PointXYZ>(cloud));
  adapter.setIndices(std::make_shared<pcl::Indices>(pcl::Indices{5, 6}));
  adapter.setWeights(test::random_weights(300, 4));
  EXPECT_NO_THROW(adapter.compute());
  EXPECT_EQ(adapter.getUsedIndices(), (pcl::Indices{5, 6}));
}

TEST(PclRqe, RefusesToMeasureNothing) {
  PclRqe<pcl::PointXYZ> adapter;
  EXPECT_THROW(adapter.compute(), Error);
  adapter.setInputCloud(std::make_shared<pcl::PointCloud<pcl::PointXYZ>>());
  EXPECT_THROW(adapter.compute(), Error);
}

TEST(PclRqe, RefusesWidthsThatNoNumberCanHoldTheResultOf) {
  PclRqe<pcl::PointXYZ> adapter;
  adapter.setInputCloud(as_pcl<pcl::PointXYZ>(test::room_corner(300, 1, 0.01, 5)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double sigma : {1e-300, 1e-7, 0.0, -0.05, 1e7, 1e150, 1e200, 1e300, nan}) {
    adapter.setSigma(sigma);
    try {
      adapter.compute();
      FAIL() << sigma;
    } catch (const Error& error) {
      EXPECT_NE(error.advice().find("sigma must lie in 1e-06 to 1000000 m"), std::string::npos)
          << error.what();
    }
  }
  for (const double sigma : {1e-6, 1e6}) {
    adapter.setSigma(sigma);
    EXPECT_TRUE(std::isfinite(adapter.compute().value)) << sigma;
  }
}

TEST(PclRqe, RefusesIndicesThatTheCloudDoesNotHave) {
  PclRqe<pcl::PointXYZ> adapter;
  adapter.setInputCloud(as_pcl<pcl::PointXYZ>(test::room_corner(300, 1, 0.01, 6)));
  adapter.setWeights(std::vector<double>(300, 1));
  for (const int index : {300, 1'000'000'000, -1}) {
    adapter.setIndices(std::make_shared<pcl::Indices>(pcl::Indices{5, index}));
    EXPECT_THROW(adapter.compute(), Error) << index;
  }
}

}  // namespace
}  // namespace crisp
