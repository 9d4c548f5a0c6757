// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/grabbers/bag/bag_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::bag;
using test::kBegin;
using test::kMs;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

struct TestPoint {
  float x, y, z, intensity;
  std::uint32_t t;  ///< [ns]
  std::uint16_t ring = 0;
};
static_assert(sizeof(TestPoint) == 24);

/// A PointCloud2 whose points are as `TestPoint` in a struct.
std::string point_cloud(std::int64_t stamp_ns, const std::vector<TestPoint>& points, bool with_times = true) {
  constexpr std::uint8_t kUnsigned16 = 4, kUnsigned32 = 6, kFloat32 = 7;
  struct Field {
    const char* name;
    std::uint8_t type;
  };
  std::vector<Field> fields = {{"x", kFloat32},         {"y", kFloat32},    {"z", kFloat32},
                               {"intensity", kFloat32}, {"t", kUnsigned32}, {"ring", kUnsigned16}};
  if (!with_times) fields[4].name = "padding";
  test::RosBytes bytes(false);
  bytes.header(stamp_ns).put(std::uint32_t{1}).put(static_cast<std::uint32_t>(points.size()));
  bytes.put(static_cast<std::uint32_t>(fields.size()));
  for (std::uint32_t i = 0; i < fields.size(); ++i)
    bytes.text(fields[i].name).put(4 * i).put(fields[i].type).put(std::uint32_t{1});
  std::vector<std::uint8_t> data(sizeof(TestPoint) * points.size());
  std::memcpy(data.data(), points.data(), data.size());
  bytes.put(std::uint8_t{0})
      .put(std::uint32_t{sizeof(TestPoint)})
      .put(static_cast<std::uint32_t>(data.size()));
  return bytes.list(data).put(std::uint8_t{1}).bytes();
}

class PointClouds : public test::BagFixture {
 protected:
  PointClouds() {
    rig_.lasers[0].topic = "/points";
    bag_.topics.push_back({"/points", "sensor_msgs/PointCloud2", ""});
    bag_.topics.back().definition =
        "Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\nuint32 point_step\n"
        "uint32 row_step\nuint8[] data\nbool is_dense\n===\nMSG: sensor_msgs/PointField\nuint8 INT8=1\nstring name\n"
        "uint32 offset\nuint8 datatype\nuint32 count\n===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\n"
        "string frame_id\n";
  }

  void add_points(std::int64_t ms, const std::vector<TestPoint>& points, bool with_times = true) {
    bag_.messages.push_back(
        {3, kBegin + (ms + 40) * kMs, point_cloud(kBegin + ms * kMs, points, with_times)});
  }

  /// A rig of rings at these elevations on a head.
  void use_head(std::size_t rings) {
    rig_.plate.topic = "/points";
    rig_.lasers.clear();
    for (std::size_t i = 0; i < rings; ++i) {
      rig_.lasers.push_back({.name = "ring" + std::to_string(i),
                             .topic = "/points",
                             .ring = static_cast<int>(i),
                             .mount = -kPi / 2});
      rig_.lasers.back().nominal.alpha.value = -kPi / 2;
    }
  }

  /// Records 0.2 s of a head that turns at 10 Hz, clockwise seen from above: its rings see a cylinder of 4 m.
  /// @param tilt     [rad] of the frame about x in which the points are recorded
  /// @param azimuth  [rad] by which odd rings lead
  void record_head(const std::vector<double>& elevations, double tilt = 0, double azimuth = 0) {
    constexpr std::uint32_t kFiring = 200'000;  // [ns]
    for (std::int64_t ms = 0; ms < 200; ms += 50) {
      std::vector<TestPoint> points;
      for (std::uint32_t t = 0; t < 50 * kMs; t += kFiring) {
        for (std::size_t ring = 0; ring < elevations.size(); ++ring) {
          const double a =
              azimuth_at(1e-3 * static_cast<double>(ms) + 1e-9 * t) + (ring % 2 == 1 ? azimuth : 0);
          const double x = kRadius * std::cos(a), y = kRadius * std::sin(a);
          const double z = kRadius * std::tan(elevations[ring]);
          points.push_back({static_cast<float>(x),
                            static_cast<float>(y * std::cos(tilt) - z * std::sin(tilt)),
                            static_cast<float>(y * std::sin(tilt) + z * std::cos(tilt)), 5, t,
                            static_cast<std::uint16_t>(ring)});
        }
      }
      add_points(ms, points);
    }
  }
  static double azimuth_at(double time) { return 1 - 20 * kPi * time; }

  static constexpr double kRadius = 4;
};

TEST_F(PointClouds, OfA2DLaserAreReadWithTheirTimes) {
  rig_.plate.joint = "tilt";
  add_joint(0, 0.5);
  const float nan = std::nanf("");
  add_points(
      0, {{0, 2, 0, 7, 3'000'000}, {3, 0, 0, 8, 1'000'000}, {nan, nan, nan, 0, 0}, {1, 1, 1, 9, 2'000'000}});
  add_joint(100, 1.5);
  auto stage = run();
  const auto beams = stage.given<Measurements>().at(0);
  EXPECT_THAT(beams->range, ElementsAre(3, 2));
  EXPECT_THAT(beams->time, ElementsAre(0.001, 0.003));
  EXPECT_THAT(beams->mirror_angle, ElementsAre(-0.5F, testing::FloatEq(1.5707964F - 0.5F)))
      << "less the mount";
  EXPECT_THAT(beams->remission, ElementsAre(8, 7));
  EXPECT_EQ(stage.report().counts.at("points outside of the scan plane z = 0"), 1U);
  bag_.messages[1].bytes.resize(100);
  EXPECT_THAT(complaint(), "nothing");
  EXPECT_EQ(run().report().counts.at("messages that end before their content"), 1U);
}

TEST_F(PointClouds, OfARotatingHeadAreFixedBeamsOnThePlate) {
  const std::vector<double> elevations = {-0.2, 0, 0.1};
  use_head(3);
  record_head(elevations);
  auto stage = run();
  const auto head = stage.given<PlateTrajectory>().at(0);
  std::size_t beams = 0;
  for (const auto& some : stage.given<Measurements>()) {
    EXPECT_EQ(some->epoch_ns, head->epoch_ns());
    for (std::size_t i = 0; i < some->size(); ++i, ++beams) {
      const double elevation = elevations[some->laser[i]];
      EXPECT_NEAR(some->mirror_angle[i], elevation + kPi / 2, 1e-6);
      EXPECT_NEAR(some->range[i], kRadius / std::cos(elevation), 1e-6);
      const double time = some->time[i] - (1e-9 * static_cast<double>(kBegin - head->epoch_ns()));
      ASSERT_TRUE(head->at(some->time[i]));
      EXPECT_NEAR(std::remainder(head->at(some->time[i])->angle - azimuth_at(time), 2 * kPi), 0, 1e-5);
    }
  }
  EXPECT_EQ(beams, 3U * 1000U);
  EXPECT_NEAR(head->angles().back() - head->angles().front(), -20 * kPi * 0.1998, 1e-4) << "two turns";
}

TEST_F(PointClouds, OfARingThatTheRigLeavesOutAreCounted) {
  use_head(2);
  record_head({-0.2, 0, 0.1});
  EXPECT_EQ(run().report().counts.at("points of rings that the rig does not name"), 1000U);
}

TEST_F(PointClouds, OfAnotherFrameThanTheHeadsAreRefused) {
  use_head(2);
  record_head({-0.2, 0.1}, 0.3);
  EXPECT_THAT(complaint(), HasSubstr("points of ring 0 on /points are off its cone"));
}

TEST_F(PointClouds, OfRingsWithAzimuthsOfTheirOwnNeedTheirLambda) {
  use_head(2);
  record_head({-0.2, 0.1}, 0, 0.1);
  EXPECT_THAT(complaint(), HasSubstr("the rings' azimuths contradict one another"));
  rig_.lasers[1].nominal.lambda.value = 0.1;
  EXPECT_EQ(complaint(), "nothing");
}

TEST_F(PointClouds, OfARotatingHeadNeedTimes) {
  use_head(1);
  add_points(0, {{1, 0, 0, 1, 0}}, false);
  EXPECT_THAT(complaint(), HasSubstr("the points on /points have no times"));
}

TEST_F(PointClouds, OfA3DLaserOnAPlateAreThoseOfARingInItsPlaneOrRefused) {
  rig_.plate.joint = "tilt";
  rig_.lasers[0].ring = 1;
  add_joint(0, 0.5);
  record_head({-0.2, 0, 0.1});
  add_joint(300, 1.5);
  EXPECT_EQ(run().report().counts.at("points of rings that the rig does not name"), 2000U);
  rig_.lasers[0].ring = 2;
  EXPECT_THAT(complaint(),
              HasSubstr("1000 of 1000 points of front on /points are outside of the plane z = 0"));
}

TEST_F(PointClouds, OfOneTopicAreOfSeveralLasersByTheirRingsOnly) {
  const auto complaint_of = [&] {
    auto stage = test::StageDriver::of<BagStage>({{"file", OptionScalar("a.bag")}});
    stage.run().rig = rig_;
    try {
      stage.check();
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  use_head(2);
  EXPECT_EQ(complaint_of(), "nothing");
  rig_.lasers[1].ring = 0;
  EXPECT_THAT(complaint_of(), HasSubstr("ring0 and ring1 have the same scans, of /points"));
  rig_.lasers[1].ring = 1;
  rig_.lasers[1].mount = 0.1;
  EXPECT_THAT(complaint_of(), HasSubstr("write ring1: {mount: -90deg, …}"));
  rig_.lasers.resize(1);
  rig_.lasers[0].ring.reset();
  add_points(0, {{1, 0, 0, 1, 0}});
  EXPECT_THAT(complaint(), HasSubstr("the rig names no ring"));
}

}  // namespace
}  // namespace crisp
