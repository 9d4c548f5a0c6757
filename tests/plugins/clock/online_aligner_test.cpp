// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <crisp/clock_aligner.hpp>

#include "tests/plugins/clock/aligned.hpp"

namespace crisp {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

/// The scans whose first beam was fired after a true time, with their turns.
TimeErrors errors_after(double t, const Aligned& aligned, std::uint16_t index, const SimulatedLaser& laser,
                        const Turns& turns) {
  const auto scans = aligned.of_laser(index);
  EXPECT_EQ(scans.size(), turns.size());
  std::vector<double> errors;
  for (std::size_t i = 0; i < std::min(scans.size(), turns.size()); ++i) {
    if (turns[i].begin < t) continue;
    for (const std::size_t k : {std::size_t{0}, scans[i]->size() - 1}) {
      const double fired = turns[i].begin + (k == 0 ? 0 : 0.75 * turns[i].period);
      errors.push_back(std::abs(scans[i]->time[k] - (kStart + fired + laser.minimum_delay)));
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors.empty() ? TimeErrors{HUGE_VAL, HUGE_VAL}
                        : TimeErrors{errors[errors.size() / 2], errors.back()};
}

TEST(OnlineAligner, FindsWhenEachBeamWasFiredFromTheStampsSoFar) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto lasers = three_lasers(seed);
    std::vector<Turns> turns;
    for (std::uint16_t i = 0; i < 3; ++i) turns.push_back(lasers[i].turns(seed, i, 20));
    const auto aligned = align_online(turns, SimulatedPlate{}.readings(seed, 20.2));
    for (std::uint16_t i = 0; i < 3; ++i) {
      // After n stamps with delays of 100 us on the mean the line is open by 200 us / n at its middle, and
      // some times that at its end: 10 us after two seconds. A parabola through 11 stamps of whole
      // microseconds ends within one of them, and the mirror wanders by 2 us within it.
      const auto errors = errors_after(2, aligned, i, lasers[i], turns[i]);
      EXPECT_LT(errors.median, 8e-6) << "seed " << seed << " laser " << i;
      EXPECT_LT(errors.worst, 60e-6) << "seed " << seed << " laser " << i;
      EXPECT_LT(errors_after(0, aligned, i, lasers[i], turns[i]).worst, 500e-6) << "in the first two seconds";
      EXPECT_NEAR(aligned.report.devices[i].clock->skew_ppm(), 1e6 * lasers[i].clock.skew(0), 2);
      EXPECT_LT(aligned.report.devices[i].clock->skew_std_error, 5e-6);
      EXPECT_NEAR(aligned.report.devices[i].clock->residual_median, 69e-6, 10e-6) << "100 us times ln 2";
    }
  }
}

/// When, by the latest receipt, each scan was handed out after its own receipt.
std::vector<double> waits(const OnlineSettings& settings, const std::function<bool(double)>& reading_is_lost,
                          AlignmentReport* report = nullptr) {
  SimulatedLaser laser;
  SimulatedPlate plate;
  plate.is_lost = reading_is_lost;
  const auto turns = laser.turns(1, 0, 5);
  Rig rig = default_rig();
  rig.lasers.resize(1);
  std::vector<double> waits;
  double now = 0;
  OnlineAligner aligner(rig, {}, settings,
                        {.trajectory = [](const PlateTrajectory&) {},
                         .measurements =
                             [&](const std::shared_ptr<const Measurements>&) {
                               const auto& scan = turns.at(waits.size()).scan;
                               waits.push_back(now - 1e-9 * static_cast<double>(scan.receipt_ns - kStart_ns));
                             }});
  std::multimap<std::int64_t, std::function<void()>> arrivals;
  for (const auto& turn : turns) {
    arrivals.emplace(turn.scan.receipt_ns, [&] { aligner.add(std::make_shared<const Scan>(turn.scan)); });
  }
  for (const auto& reading : plate.readings(1, 6)) {
    arrivals.emplace(reading.receipt_ns, [&aligner, reading] { aligner.add(reading); });
  }
  for (const auto& [receipt, arrive] : arrivals) {
    now = 1e-9 * static_cast<double>(receipt - kStart_ns);
    arrive();
  }
  const AlignmentReport found = aligner.finish();
  if (report != nullptr) *report = found;
  EXPECT_EQ(waits.size(), turns.size());
  return waits;
}

constexpr auto kNoneLost = [](double) { return false; };

TEST(OnlineAligner, HandsAScanOnAsSoonAsThePlateCoversIt) {
  const auto found = waits({.warm_up = 0.5}, kNoneLost);
  for (std::size_t i = 50; i < found.size(); ++i) EXPECT_LT(found[i], 1e-6) << "the plate is there already";
  EXPECT_NEAR(found[0], 0.5, 0.03) << "the first waits for its laser's clock";
}

TEST(OnlineAligner, WaitsForTheReadingsThatALagNeeds) {
  // A sweep ends 15 ms after its begin, and comes in 8 ms later with 1 ms of delay at least; the plate's
  // reading of 12 ms after it comes half a millisecond after that, and readings are 2 ms apart.
  const auto found = waits({.warm_up = 0.5, .greatest_lag = 12e-3}, kNoneLost);
  for (std::size_t i = 50; i < found.size(); ++i) {
    EXPECT_GT(found[i], 1e-3);
    EXPECT_LT(found[i], 7e-3);
  }
}

TEST(OnlineAligner, LeavesAMarginToLagsThatMayBecomeGreater) {
  Calibration calibration;
  for (const double eta : {1e-3, -2e-3, 4e-3}) calibration.lasers.push_back({.eta = {.value = eta}});
  const OnlineSettings settings = with_lags({.lag_margin = 2e-3}, calibration);
  EXPECT_EQ(settings.least_lag, -2e-3);
  EXPECT_EQ(settings.greatest_lag, 4e-3 + 2e-3);
}

TEST(OnlineAligner, WaitsNoLongerThanItsPatienceForAPlateThatFellSilent) {
  AlignmentReport report;
  const auto found = waits(
      {.warm_up = 0.3, .plate_timeout = 0.2}, [](double t) { return t > 2 && t < 4; }, &report);
  EXPECT_LT(*std::ranges::max_element(found), 0.55);
  // All scans of 2 s but those in the last half second, which the encoder readings then cover.
  EXPECT_NEAR(static_cast<double>(report.counts.at("scans passed on without encoder readings (timeout)")), 75,
              5);
}

TEST(OnlineAligner, FindsAClockAnewAfterItsDeviceStartedAgain) {
  SimulatedLaser laser;
  laser.clock = {.start = 700, .skew = [](double) { return 120e-6; }, .reset_at = 6};
  auto turns = laser.turns(3, 0, 12);
  // A scan that was stamped before and sent after it has times that fit no clock.
  EXPECT_GT(
      std::erase_if(turns,
                    [](const auto& turn) { return turn.scan.scan_time_us > turn.scan.transmission_time_us; }),
      0U);
  const auto aligned = align_online({turns}, SimulatedPlate{}.readings(3, 12.2));
  EXPECT_EQ(aligned.report.devices[0].resets, 1u);
  const auto scans = aligned.of_laser(0);
  ASSERT_EQ(scans.size(), turns.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const double since = turns[i].begin > 5.97 ? turns[i].begin - 5.97 : turns[i].begin;
    if (turns[i].begin > 5.95 && turns[i].begin < 6.03) continue;  // swept over the reset
    // In the first seconds of a clock its least delay so far counts, of 100 us on the mean.
    EXPECT_NEAR(scans[i]->time.front(), kStart + turns[i].begin + laser.minimum_delay,
                since < 2 ? 500e-6 : 60e-6)
        << turns[i].begin;
  }
}

}  // namespace
}  // namespace crisp
