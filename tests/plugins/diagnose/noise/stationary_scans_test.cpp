// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/stationary_scans.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "plugins/diagnose/noise/noise_stage.hpp"
#include "tests/support/stage_driver.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Beam k measures 2 m + k dm, ± 1 cm.
Scan scan_at(std::size_t number, float grows_by = 0) {
  Scan scan;
  scan.receipt_ns = static_cast<std::int64_t>(number) * 20'000'000;
  auto& echo = scan.echoes.emplace_back();
  for (std::size_t k = 0; k < 50; ++k) {
    const float noise = (number * 7 + k * 3) % 5 < 2 ? 0.01F : -0.01F;
    echo.ranges.push_back(2 + 0.1F * static_cast<float>(k) + noise + grows_by * static_cast<float>(number));
  }
  return scan;
}

std::string why_nothing(const StationaryScans& scans) {
  const auto judged = scans.errors();
  const auto* nothing = std::get_if<InsufficientData>(&judged);
  return nothing ? nothing->why : "";
}

StationaryScans of_scans(std::size_t n, float grows_by = 0) {
  StationaryScans scans;
  for (std::size_t i = 0; i < n; ++i) scans.add(scan_at(i, grows_by));
  return scans;
}

TEST(StationaryScans, AreInsufficientIfFew) {
  EXPECT_THAT(why_nothing(of_scans(1)), HasSubstr("it sent only 1 scans"));
  EXPECT_EQ(why_nothing(of_scans(10)), "");
}

TEST(StationaryScans, IgnoreScansWithoutRanges) {
  StationaryScans scans;
  Scan empty = scan_at(0);
  empty.echoes[0].ranges.clear();
  scans.add(empty);
  for (std::size_t i = 1; i < 20; ++i) scans.add(scan_at(i));
  EXPECT_EQ(why_nothing(scans), "");
  EXPECT_EQ(scans.left_out(), 1U);
}

TEST(StationaryScans, DistinguishAMovingLaserFromOneWithoutEchoes) {
  EXPECT_THAT(why_nothing(of_scans(20, 0.1F)), HasSubstr("scene moves"));
  StationaryScans silent;
  for (std::size_t i = 0; i < 20; ++i) {
    Scan scan = scan_at(i);
    scan.echoes[0].ranges.assign(50, 0);
    silent.add(scan);
  }
  EXPECT_THAT(why_nothing(silent), HasSubstr("no beam has echoes"));
}

/// Ranges with some shots 1 m nearer, by the given predicate: an object that moves by a beam per scan, a
/// static one, or random outliers.
StationaryScans with(const std::function<bool(std::size_t scan, std::size_t beam)>& is_nearer) {
  StationaryScans scans;
  for (std::size_t i = 0; i < 60; ++i) {
    Scan scan = scan_at(i);
    for (std::size_t k = 0; k < 50; ++k) scan.echoes[0].ranges[k] -= is_nearer(i, k) ? 1.0F : 0.0F;
    scans.add(scan);
  }
  return scans;
}

TEST(StationaryScans, DistinguishMovingObjectsFromOutliersAndFlicker) {
  const auto walks = [](std::size_t scan, std::size_t beam) {
    return beam >= 10 && beam < 30 && beam + 12 <= scan && scan < beam + 20;
  };
  const auto found = find_moving_objects(with(walks).far_shots(), 1, 1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->directions, 20U);
  EXPECT_NEAR(found->share, 160.0 / 3000, 1e-9);
  EXPECT_LT(found->p_value, 0.002);
  const Finding finding = finding_of(*found);
  EXPECT_EQ(finding.cause, "scene.moving");
  EXPECT_TRUE(finding.accepted);
  const auto rest = with(walks).errors(found->beams);
  for (const float error : std::get<RangeErrors>(rest).value) EXPECT_LT(std::abs(error), 0.03);

  std::mt19937 random(4);
  const auto anywhere = [&](std::size_t, std::size_t) { return random() % 20 == 0; };
  EXPECT_FALSE(find_moving_objects(with(anywhere).far_shots(), 1, 1)) << "outliers in 5 % of all shots";
  const auto flickers = [](std::size_t scan, std::size_t beam) { return beam % 10 == 0 && scan % 3 == 0; };
  EXPECT_FALSE(find_moving_objects(with(flickers).far_shots(), 1, 1));
  const auto all_at_once = [](std::size_t scan, std::size_t) { return scan > 50; };
  EXPECT_FALSE(find_moving_objects(with(all_at_once).far_shots(), 1, 1)) << "common to all beams";
  EXPECT_FALSE(find_moving_objects(with([](std::size_t, std::size_t) { return false; }).far_shots(), 1, 1));
}

TEST(PlateStandstill, ToleratesJitterOfAFewSteps) {
  PlateStandstill plate;
  EXPECT_FALSE(plate.turned()) << "without readings";
  for (const std::uint32_t count : {4'294'967'295U, 0U, 1U, 4'294'967'295U}) plate.add({.count = count});
  EXPECT_FALSE(plate.turned());
  plate.add({.count = 4});
  EXPECT_TRUE(plate.turned());
}

test::StageDriver noise_stage() {
  auto driver = test::StageDriver::of<DiagnoseNoiseStage>({});
  driver.run().rig.lasers = {{.name = "a"}};
  return driver;
}

TEST(DiagnoseNoise, ReportsALaserOnATurningPlateAsUnobservable) {
  for (const bool turns : {false, true}) {
    auto driver = noise_stage();
    for (std::size_t i = 0; i < 30; ++i) {
      driver.feed(PlateReading{.count = turns ? static_cast<std::uint32_t>(i) : 0});
      driver.feed(scan_at(i));
    }
    driver.finish();
    const Findings& found = *driver.given<Findings>().at(0);
    EXPECT_THAT(found.noise, SizeIs(turns ? 0 : 1));
    EXPECT_EQ(std::isnan(found.before_p), turns) << "no ranges were compared";
    EXPECT_EQ(std::isnan(found.after_p), turns);
    ASSERT_THAT(found.unobservable, SizeIs(turns ? 1 : 0));
    if (turns) {
      EXPECT_THAT(found.unobservable[0].reason, HasSubstr("turned"));
    }
  }
}

TEST(DiagnoseNoise, ReportsASingleScanAsUnobservable) {
  auto driver = noise_stage();
  driver.feed(scan_at(0));
  driver.finish();
  const Findings& found = *driver.given<Findings>().at(0);
  EXPECT_THAT(found.noise, IsEmpty());
  EXPECT_THAT(found.unnamed, IsEmpty());
  ASSERT_THAT(found.unobservable, SizeIs(1));
  EXPECT_EQ(found.unobservable[0].parameter, "a.noise.normal");
}

}  // namespace
}  // namespace crisp
