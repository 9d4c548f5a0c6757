// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/at_rest.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "plugins/diagnose/noise_stage.hpp"
#include "tests/support/stage_driver.hpp"

namespace crisp {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Beam k 2 m + k dm away, give or take a centimetre.
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

std::string why_nothing(const AtRest& scans) {
  const auto judged = scans.errors();
  const auto* nothing = std::get_if<NothingSaid>(&judged);
  return nothing ? nothing->why : "";
}

AtRest of_scans(std::size_t n, float grows_by = 0) {
  AtRest scans;
  for (std::size_t i = 0; i < n; ++i) scans.add(scan_at(i, grows_by));
  return scans;
}

TEST(AtRest, FewScansSayNothing) {
  EXPECT_THAT(why_nothing(of_scans(1)), HasSubstr("1 scans are too few"));
  EXPECT_EQ(why_nothing(of_scans(10)), "");
}

TEST(AtRest, ALaserThatMovesIsToldFromOneWithoutEchoes) {
  EXPECT_THAT(why_nothing(of_scans(20, 0.1F)), HasSubstr("it moves"));
  AtRest silent;
  for (std::size_t i = 0; i < 20; ++i) {
    Scan scan = scan_at(i);
    scan.echoes[0].ranges.assign(50, 0);
    silent.add(scan);
  }
  EXPECT_THAT(why_nothing(silent), HasSubstr("no beam came back"));
}

TEST(PlateRest, APlateThatIsHeldShakesByASteps) {
  PlateRest plate;
  EXPECT_FALSE(plate.turned()) << "there are no readings";
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

TEST(NoiseStage, SaysNothingOfALaserWhosePlateTurns) {
  for (const bool turns : {false, true}) {
    auto driver = noise_stage();
    for (std::size_t i = 0; i < 30; ++i) {
      driver.feed(PlateReading{.count = turns ? static_cast<std::uint32_t>(i) : 0});
      driver.feed(scan_at(i));
    }
    driver.finish();
    const Findings& found = *driver.given<Findings>().at(0);
    EXPECT_THAT(found.noise, SizeIs(turns ? 0 : 1));
    EXPECT_EQ(std::isnan(found.before_p), turns) << "nothing was compared";
    EXPECT_EQ(std::isnan(found.after_p), turns);
    ASSERT_THAT(found.unobservable, SizeIs(turns ? 1 : 0));
    if (turns) {
      EXPECT_THAT(found.unobservable[0].reason, HasSubstr("turned"));
    }
  }
}

TEST(NoiseStage, SaysNothingOfOneScan) {
  auto driver = noise_stage();
  driver.feed(scan_at(0));
  driver.finish();
  const Findings& found = *driver.given<Findings>().at(0);
  EXPECT_THAT(found.noise, IsEmpty());
  EXPECT_THAT(found.unnamed, IsEmpty());
  ASSERT_THAT(found.unobservable, SizeIs(1));
  EXPECT_EQ(found.unobservable[0].parameter, "noise.normal of a");
}

}  // namespace
}  // namespace crisp
