// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/effect_injection.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include <crisp/registrar.hpp>

#include "grabbers/simulate/inject_stage.hpp"
#include "tests/support/built_in_terms.hpp"
#include "tests/support/stage_driver.hpp"

namespace crisp {
namespace {

using namespace crisp::simulate;

constexpr double kPeriod = 0.02;

/// A scan every 20 ms by a clock that wraps soon, received 1 ms later; 1000 beams of 2 m, the first without
/// an echo.
Scan scan_number(int n) {
  Scan scan{.scan_time_us = 0xffffff00U + static_cast<std::uint32_t>(n) * 20'000U,
            .receipt_ns = 1'700'000'000'000'000'000 + n * 20'000'000LL + 1'000'000,
            .scan_frequency = 1 / kPeriod,
            .echoes = {{.ranges = std::vector<float>(1000, 2.0F), .remissions = {}}}};
  scan.transmission_time_us = scan.scan_time_us + 3000;
  scan.echoes[0].ranges[0] = 0;
  return scan;
}

test::StageDriver driver(const OptionGroups& effects) {
  static const Registrar kRegistrar = [] {
    Registrar registrar;
    static TermRegistry terms = built_in_terms();
    registrar.attach(terms);
    return registrar;
  }();
  auto stage = test::StageDriver::of<InjectStage>({{"effects", effects}});
  stage.run().registrar = &kRegistrar;
  return stage;
}

struct Change {
  double device = 0;  ///< [s] of its stamps
  double receipt = 0;
  Scan scan;
};

/// What becomes of 100 scans.
std::vector<Change> changed(const OptionGroup& effect) {
  auto stage = driver({effect});
  stage.check();
  for (int n = 0; n < 100; ++n) stage.feed(scan_number(n));
  std::vector<Change> changes;
  for (int n = 0; n < 100; ++n) {
    const Scan before = scan_number(n);
    const Scan after = *stage.given<Scan>().at(static_cast<std::size_t>(n));
    const auto shift = static_cast<std::int32_t>(after.scan_time_us - before.scan_time_us);
    EXPECT_EQ(after.transmission_time_us - after.scan_time_us, 3000U);
    changes.push_back(
        {1e-6 * shift, 1e-9 * static_cast<double>(after.receipt_ns - before.receipt_ns), after});
  }
  return changes;
}

TEST(InjectEffects, OfTimesChangesStampsAndReceiptsByTheEffect) {
  const auto slow = changed({"mirror.period", {{"excess", "100us", {}}}, {}});
  EXPECT_NEAR(slow[50].device, 50 * 100e-6, 1e-6);
  EXPECT_NEAR(slow[50].receipt, 50 * 100e-6, 1e-6) << "taken later, so received later";
  const auto skewed = changed({"clock.drift", {{"skew", "100ppm", {}}}, {}});
  EXPECT_NEAR(skewed[50].device, -100e-6 * 50 * kPeriod, 1.1e-6)
      << "fewer device seconds in a second of the hub";
  EXPECT_EQ(skewed[50].receipt, 0);
  const auto queued = changed({"latency.step", {{"by", "1ms", {}}, {"at", "0.99s", {}}}, {}});
  EXPECT_EQ(queued[49].receipt, 0);
  EXPECT_NEAR(queued[50].receipt, 1e-3, 1e-9);
  EXPECT_EQ(queued[50].device, 0);
  const auto jumped = changed({"clock.step", {{"by", "2ms", {}}, {"at", "0.99s", {}}}, {}});
  EXPECT_EQ(jumped[49].device, 0);
  EXPECT_NEAR(jumped[50].device, 2e-3, 1e-9);
}

TEST(InjectEffects, OfRangesAddsTheEffectAndKeepsCodes) {
  const auto stepped = changed({"range.step", {{"h", "-5mm", {}}, {"at", "0.99s", {}}}, {}});
  EXPECT_FLOAT_EQ(stepped[49].scan.echoes[0].ranges[1], 2.0F);
  EXPECT_FLOAT_EQ(stepped[50].scan.echoes[0].ranges[1], 2.005F) << "it reports more: h takes that away";
  EXPECT_EQ(stepped[50].scan.echoes[0].ranges[0], 0);
  const auto noisy = changed({"noise.normal", {{"sigma", "5mm", {}}}, {}});
  double squares = 0;
  double count = 0;
  for (const Change& change : noisy) {
    EXPECT_EQ(change.scan.echoes[0].ranges[0], 0);
    for (std::size_t beam = 1; beam < 1000; ++beam, ++count) {
      squares += std::pow(double{change.scan.echoes[0].ranges[beam]} - 2, 2);
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 5e-3, 4 * 5e-3 / std::sqrt(2 * count));
}

TEST(InjectEffects, OfTwoPeaksIsAlsoForBeamsThatCameLater) {
  auto stage = driver({{"noise.two_peaks", {{"separation", "20mm", {}}}, {}}});
  Scan scan = scan_number(0);
  for (const std::size_t beams : {0, 2, 1000}) {
    scan.echoes[0].ranges.assign(beams, 2.0F);
    stage.feed(scan);
  }
  const auto changed = stage.given<Scan>();
  for (std::size_t n = 0; n < 3; ++n) {
    for (const float range : changed.at(n)->echoes[0].ranges) EXPECT_NEAR(std::abs(range - 2), 0.01, 1e-6);
  }
  EXPECT_EQ(changed.at(2)->echoes[0].ranges.size(), 1000U);
}

TEST(InjectEffects, WithoutEffectsChangesNothing) {
  auto stage = driver({});
  stage.feed(scan_number(7));
  stage.feed(PlateReading{.count = 5});
  const Scan scan = *stage.given<Scan>().at(0);
  EXPECT_EQ(scan.scan_time_us, scan_number(7).scan_time_us);
  EXPECT_EQ(scan.receipt_ns, scan_number(7).receipt_ns);
  EXPECT_EQ(scan.echoes[0].ranges, scan_number(7).echoes[0].ranges);
  EXPECT_EQ(stage.given<PlateReading>().at(0)->count, 5U);
}

TEST(InjectEffects, OfEffectsNotInScansIsRefused) {
  EXPECT_THROW(driver({{"mirror.cone", {{"kappa", "1deg", {}}}, {}}}).check(), Errors);
}

}  // namespace
}  // namespace crisp
