// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/encoded_cloud.hpp"

#include <gtest/gtest.h>

#include <random>

#include "plugins/report/base64.hpp"
#include "tests/plugins/report/decoded_cloud.hpp"

namespace crisp {
namespace {

using namespace crisp::report;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// n points at random in a cube of this side [m].
ShownCloud random_cloud(std::size_t n, double side) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-side / 2, side / 2);
  ShownCloud cloud{.of = n};
  for (std::size_t i = 0; i < n; ++i) {
    for (auto* axis :
         {&cloud.after.x, &cloud.after.y, &cloud.after.z, &cloud.before.x, &cloud.before.y, &cloud.before.z})
      axis->push_back(place(random));
    cloud.laser.push_back(static_cast<std::uint16_t>(i % 3));
    cloud.beam.push_back(static_cast<std::uint16_t>(i % 1081));
    cloud.remission.push_back(static_cast<float>(i % 255));
    cloud.time.push_back(1000 + 0.001 * static_cast<double>(i));
    cloud.range.push_back(0.5 + 0.01 * static_cast<double>(i % 3000));
    cloud.incidence.push_back(i % 2 == 0 ? kNone : 0.5);
    cloud.distance.push_back(i % 2 == 0 ? kNone : -0.012);
    cloud.distance_before.push_back(i % 2 == 0 ? kNone : 9.0);
  }
  return cloud;
}

void expect_near(const std::vector<double>& found, const std::vector<double>& truth, double error) {
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) ASSERT_NEAR(found[i], truth[i], error) << i;
}

void expect_points_within_a_millimetre(const ShownCloud& cloud) {
  const EncodedCloud encoded = encode(cloud);
  const double error = encoded.header.at("error");
  EXPECT_LE(error, 1e-3);
  const auto columns = test::decoded_cloud(encoded);
  constexpr double kRounding = 1e-9;
  expect_near(columns.at("x"), cloud.after.x, error + kRounding);
  expect_near(columns.at("y"), cloud.after.y, error + kRounding);
  expect_near(columns.at("z"), cloud.after.z, error + kRounding);
  expect_near(columns.at("x_before"), cloud.before.x, error + kRounding);
  expect_near(columns.at("z_before"), cloud.before.z, error + kRounding);
}

TEST(EncodedCloud, IsOffByLessThanAMillimetreInARoom) {
  expect_points_within_a_millimetre(random_cloud(5000, 12));
}

TEST(EncodedCloud, IsOffByLessThanAMillimetreOutdoorsToo) {
  expect_points_within_a_millimetre(random_cloud(5000, 300));
}

TEST(EncodedCloud, KeepsWhatIsKnownOfEachPoint) {
  const ShownCloud cloud = random_cloud(4000, 12);
  const auto columns = test::decoded_cloud(encode(cloud));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_EQ(columns.at("laser")[i], cloud.laser[i]);
    ASSERT_EQ(columns.at("beam")[i], cloud.beam[i]);
    ASSERT_NEAR(columns.at("remission")[i], double{cloud.remission[i]}, 0.51);
    ASSERT_NEAR(columns.at("time")[i], cloud.time[i], 1e-4);
    ASSERT_NEAR(columns.at("range")[i], cloud.range[i], 1.001e-3);
  }
}

TEST(EncodedCloud, DistinguishesNoSurfaceFromADistance) {
  const auto columns = test::decoded_cloud(encode(random_cloud(10, 12)));
  EXPECT_TRUE(std::isnan(columns.at("distance")[0]));
  EXPECT_TRUE(std::isnan(columns.at("incidence")[0]));
  EXPECT_NEAR(columns.at("distance")[1], -0.012, 1e-9);
  EXPECT_NEAR(columns.at("incidence")[1], 28.6, 0.51);  // [deg]
  EXPECT_NEAR(columns.at("distance_before")[1], 0.127, 1e-9) << "far off is as far as the byte reaches";
}

TEST(EncodedCloud, OfOneCloudHasNoColumnsOfTheOther) {
  ShownCloud cloud = random_cloud(10, 12);
  cloud.before = {};
  cloud.distance_before = {};
  const auto columns = test::decoded_cloud(encode(cloud));
  EXPECT_FALSE(columns.contains("x_before"));
  EXPECT_FALSE(columns.contains("distance_before"));
  EXPECT_TRUE(columns.contains("x"));
}

TEST(EncodedCloud, OfNoPointsIsEmpty) {
  const auto encoded = encode({});
  EXPECT_EQ(encoded.header.at("points"), 0);
  EXPECT_TRUE(test::decoded_cloud(encoded).empty());
}

// The test vectors of RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
  const auto of = [](std::string_view text) {
    return base64_of({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace crisp
