// SPDX-License-Identifier: BSD-3-Clause
// Deviations of clocks and links are identified, and straight clocks have none.
#include "plugins/diagnose/clocks/clock_stamps.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/clocks/clock_departure.hpp"
#include "plugins/diagnose/clocks/clock_plots.hpp"
#include "plugins/diagnose/clocks/device_jumps.hpp"
#include "tests/support/simulated_stamps.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::plot;
using namespace crisp::statistics;

constexpr double kRate = 50;                        // [Hz]
constexpr double kDuration = 60;                    // [s]
constexpr std::uint32_t kStart_us = 4'294'000'000;  // wraps after one second
constexpr std::int64_t kEpoch_ns = 1'700'000'000'000'000'000;

struct Hidden {
  double skew = 40e-6;
  double drift = 0;
  double wave = 0;       // [s] amplitude of a clock that runs fast and slow …
  double wave_time = 1;  // [s] … with this period
  double clock_step = 0;
  double latency_step = 0;
  double at = 1e9;
  double backlog = 0;    // [s] initial delay by a backlog …
  double caught_up = 1;  // [s] … that has ended by then
  double sent_late = 0;  // [s] delay of every 37th telegram, in its own stamp
};

/// Telegrams of a device with simulated deviations: hub time t, device time, receipt.
StampTrack track_of(std::uint64_t seed, const Hidden& hidden, const test::Delays& delays) {
  test::Random random(seed);
  StampTrack track;
  std::uint16_t counter = 65'000;  // wraps soon
  int number = 0;
  for (double taken = 0; taken < kDuration; taken += 1 / kRate) {
    constexpr int kSome = 37;
    const double t = taken + (number++ % kSome == 0 ? hidden.sent_late : 0);
    const bool stepped = t >= hidden.at;
    const double device = t / (1 + hidden.skew) - hidden.drift * t * t / 2 +
                          (stepped ? hidden.clock_step : 0) -
                          hidden.wave * std::sin(2 * std::numbers::pi * t / hidden.wave_time);
    const double receipt = t + 0.001 + delays(random) + (stepped ? hidden.latency_step : 0) +
                           hidden.backlog * std::max(0.0, 1 - t / hidden.caught_up);
    track.add(counter++, kStart_us + static_cast<std::uint32_t>(static_cast<std::int64_t>(device * 1e6)),
              kEpoch_ns + static_cast<std::int64_t>(receipt * 1e9));
  }
  return track;
}

const auto kDelays = test::exponential_delays(1e-4);

TEST(ClockStamps, AreUnwrappedAndRepeatedOnesAreLeftOut) {
  StampTrack track;
  track.add(65'535, 4'294'967'290, kEpoch_ns);
  track.add(0, 4, kEpoch_ns + 11'000);
  track.add(0, 4, kEpoch_ns + 12'000);
  track.add(3, 34, kEpoch_ns + 40'000);
  ASSERT_EQ(track.stamps().size(), 3U);
  EXPECT_EQ(track.stamps()[1].count, 1);
  EXPECT_NEAR(track.stamps()[1].stamp.device, 10e-6, 1e-12);
  EXPECT_EQ(track.stamps()[2].count, 4);
  EXPECT_NEAR(track.stamps()[2].stamp.lead, 0, 1e-12);
}

TEST(ClockStamps, ContinueAfterARestart) {
  StampTrack track;
  track.add(5'000, 100'000'000, kEpoch_ns);
  track.add(5'001, 100'020'000, kEpoch_ns + 20'000'000);
  track.add(1, 15'000, kEpoch_ns + 3'000'000'000);
  ASSERT_EQ(track.stamps().size(), 3U);
  EXPECT_EQ(track.stamps()[2].count, 2);
}

TEST(ClockStamps, OfStraightClocksHaveNoDeviation) {
  constexpr int kClocks = 200;
  int named = 0;
  for (int seed = 0; seed < kClocks; ++seed) {
    const auto delays = seed % 2 == 0 ? kDelays : test::bursty_delays(1e-4, 3e-3, 20, 0.01);
    const auto track = track_of(static_cast<std::uint64_t>(seed), {}, delays);
    if (clock_departure(track.stamps(), 1, 1)) ++named;
  }
  EXPECT_LE(named, 2);  // expected: 0.4
}

TEST(ClockStamps, EstimateAClockDrift) {
  for (const double drift : {2e-7, -2e-6}) {
    const auto track = track_of(3, {.drift = drift}, kDelays);
    const auto found = clock_departure(track.stamps(), 4, 1);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->kind, ClockDeparture::Kind::drift);
    EXPECT_NEAR(found->size, drift, 4 * found->std_error);
    EXPECT_NEAR(found->skew, 40e-6, 4 * found->skew_std_error);
    EXPECT_LT(found->gain.ci95[1], 0) << "on held-out windows";
  }
}

TEST(ClockStamps, AttributeAClockStepToTheClock) {
  for (const double step : {0.004, -0.0003, 1.5}) {
    const auto track = track_of(4, {.clock_step = step, .at = 23.4}, kDelays);
    const auto found = clock_departure(track.stamps(), 4, 1);
    ASSERT_TRUE(found) << step;
    EXPECT_EQ(found->kind, ClockDeparture::Kind::clock_step) << step;
    EXPECT_NEAR(found->size, step, std::max(20e-6, 4 * found->std_error));
    EXPECT_NEAR(found->at, 23.4, 0.03) << step;
  }
}

TEST(ClockStamps, AttributeALatencyStepToTheLink) {
  for (const double step : {0.002, -0.0004}) {
    const auto track = track_of(5, {.latency_step = step, .at = 41.2}, kDelays);
    const auto found = clock_departure(track.stamps(), 4, 1);
    ASSERT_TRUE(found) << step;
    EXPECT_EQ(found->kind, ClockDeparture::Kind::latency_step) << step;
    EXPECT_NEAR(found->size, step, std::max(20e-6, 4 * found->std_error));
    EXPECT_NEAR(found->at, 41.2, 0.1) << step;
  }
}

TEST(ClockStamps, AttributeALatencyStepDespiteLateTelegrams) {
  for (const double step : {0.001, -0.001}) {
    const auto track = track_of(5, {.latency_step = step, .at = 41.2, .sent_late = 0.001}, kDelays);
    const auto found = clock_departure(track.stamps(), 4, 1);
    ASSERT_TRUE(found) << step;
    EXPECT_EQ(found->kind, ClockDeparture::Kind::latency_step)
        << step << ": the next telegram is on time again";
    EXPECT_NEAR(found->size, step, std::max(20e-6, 4 * found->std_error));
  }
}

TEST(ClockStamps, DistinguishABacklogFromALatencyStep) {
  for (const double caught_up : {4.0, 15.0}) {
    const auto track = track_of(9, {.backlog = 0.4, .caught_up = caught_up}, kDelays);
    const auto found = clock_departure(track.stamps(), 4, 1);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->kind, ClockDeparture::Kind::backlog);
    EXPECT_GT(found->size, 0.4 * std::sqrt(caught_up / kDuration) / 4) << "seconds, RMS over all";
    EXPECT_LT(found->size, 0.4 * std::sqrt(caught_up / kDuration));
    const auto as_they_were = without_step(track.stamps(), *found);
    EXPECT_EQ(as_they_were.front().stamp.lead, track.stamps().front().stamp.lead);
  }
}

TEST(ClockStamps, NameADriftThatVaries) {
  for (const double periods : {1.0, 1.25, 2.0}) {
    const Hidden hidden{.wave = 3e-4, .wave_time = kDuration / periods};
    const auto found = clock_departure(track_of(11, hidden, kDelays).stamps(), 4, 1);
    ASSERT_TRUE(found) << periods;
    EXPECT_EQ(found->kind, ClockDeparture::Kind::varying_drift) << periods << ": no step";
    EXPECT_THAT(found->size, testing::AllOf(testing::Gt(0.4 * 3e-4), testing::Lt(3e-4))) << "RMS";
    EXPECT_TRUE(found->gain.significant_decrease());
  }
}

TEST(ClockStamps, GiveBayesFactorsAgainstAllOtherDeviations) {
  using Kind = ClockDeparture::Kind;
  const auto competitors = [](const Hidden& hidden) {
    const auto found = clock_departure(track_of(3, hidden, kDelays).stamps(), 4, 1);
    std::map<std::optional<Kind>, double> odds;
    for (const auto& competitor : found->competitors) odds[competitor.kind] = competitor.log10_bayes_factor;
    EXPECT_TRUE(
        std::ranges::is_sorted(found->competitors, {}, &ClockDeparture::Competitor::log10_bayes_factor));
    return odds;
  };
  for (const auto& [what, hidden, others] :
       {std::tuple{"drift", Hidden{.drift = 2e-6}, std::set<std::optional<Kind>>{{}, Kind::latency_step}},
        {"clock", Hidden{.clock_step = 0.004, .at = 20}, {{}, Kind::drift, Kind::latency_step}},
        {"link", Hidden{.latency_step = 0.004, .at = 20}, {{}, Kind::drift, Kind::clock_step}}}) {
    const auto odds = competitors(hidden);
    ASSERT_EQ(odds.size(), others.size()) << what;
    for (const auto& [kind, log10_bayes_factor] : odds) {
      EXPECT_TRUE(others.contains(kind)) << what;
      EXPECT_GT(log10_bayes_factor, 2) << what << ": Bayes factor 100";
    }
  }
  // The step is 40 times the intervals' spread, in place of 4000 times.
  const double small = competitors({.latency_step = 0.00004, .at = 20})[Kind::clock_step];
  EXPECT_GT(small, 2);
  EXPECT_LT(small, competitors({.latency_step = 0.004, .at = 20})[Kind::clock_step]);
}

TEST(ClockStamps, TestAClockJumpByTheSpreadOfIntervals) {
  std::vector<CountedStamp> stamps;
  constexpr double kSpread = 1e-4;  // [s] alternately early and late
  for (int k = 0; k < 60; ++k) {
    const double late = (k % 2 == 0 ? 0.5 : -0.5) * kSpread + (k < 30 ? 0 : 3 * kSpread);
    stamps.push_back({.count = k, .stamp = {.device = 0.02 * k + late, .lead = 0}});
  }
  // Student's density at 3 and at 0 scales: 2 log10(1 + 9/3) …
  const double width = kMadToSigma * kSpread;
  const double jump = device_jump(stamps, 30);
  EXPECT_NEAR(log10_odds_of_jump(stamps, 30, jump), 2 * std::log10(1 + std::pow(jump / width, 2) / 3), 1e-9);
  EXPECT_NEAR(log10_odds_of_jump(stamps, 30, 2 * jump), 0, 1e-9) << "half-way between both hypotheses";
  EXPECT_LT(log10_odds_of_jump(stamps, 20, 3 * kSpread), 0) << "without a jump";
  EXPECT_EQ(largest_device_jump(stamps, 1, 60), 30U);
}

TEST(ClockStamps, EstimateSkewAndDelays) {
  const ClockFacts facts = clock_facts(track_of(6, {}, kDelays).stamps());
  EXPECT_NEAR(facts.skew, 40e-6, 4 * facts.skew_std_error);
  EXPECT_NEAR(facts.delay_median, 1e-4 * std::log(2.0), 1e-5);
  EXPECT_NEAR(facts.delay_95, 1e-4 * std::log(20.0), 4e-5);
}

TEST(ClockStamps, EstimateSkewAndDelaysDespiteAStep) {
  const ClockFacts straight = clock_facts(track_of(6, {}, kDelays).stamps());
  for (const Hidden& hidden :
       {Hidden{.clock_step = -0.004, .at = 20}, Hidden{.latency_step = 0.003, .at = 40}}) {
    const auto track = track_of(6, hidden, kDelays);
    const auto departure = clock_departure(track.stamps(), 1, 1);
    ASSERT_TRUE(departure);
    const ClockFacts facts = clock_facts(without_step(track.stamps(), *departure));
    EXPECT_NEAR(facts.skew, straight.skew, 4 * straight.skew_std_error);
    EXPECT_NEAR(facts.delay_median, straight.delay_median, 2e-5);
    EXPECT_NEAR(facts.delay_95, straight.delay_95, 4e-5);
  }
}

TEST(ClockStamps, ArePlottedWithTheFittedDeviation) {
  const auto track = track_of(7, {.clock_step = 0.004, .at = 20}, kDelays);
  const auto departure = clock_departure(track.stamps(), 1, 1);
  ASSERT_TRUE(departure);
  const Plot plot = clock_plot("laser1", track.stamps(), departure);
  ASSERT_EQ(plot.series.size(), 3U);
  const PlotSeries& least = plot.series[1];
  const PlotSeries& found = plot.series[2];
  ASSERT_EQ(least.x, found.x);
  for (std::size_t i = 0; i < least.x.size(); ++i) EXPECT_NEAR(least.y[i], found.y[i], 0.1) << "ms";
  EXPECT_LE(plot.series[0].x.size(), 1000U);
  EXPECT_EQ(clock_plot("laser1", track.stamps(), {}).series.size(), 1U);
}

/// Number of breaks in a curve.
std::ptrdiff_t breaks_in(const PlotSeries& series) {
  return std::ranges::count_if(series.y, [](double y) { return std::isnan(y); });
}

TEST(ClockStamps, AreNotJoinedAcrossAPause) {
  StampTrack track;
  constexpr std::uint32_t kPeriod_us = 20'000, kPause_us = 30'000'000;
  std::uint32_t at = 0;
  for (std::uint16_t k = 0; k < 1000; ++k) {
    track.add(k, at, kEpoch_ns + std::int64_t{at} * 1000 + (k < 700 ? 0 : 2'000'000));
    at += k == 599 ? kPause_us : kPeriod_us;
  }
  const ClockDeparture step{.kind = ClockDeparture::Kind::latency_step, .size = 0.002, .at = 45};
  const Plot clock = clock_plot("laser1", track.stamps(), step);
  ASSERT_EQ(clock.series.size(), 3U);
  EXPECT_EQ(breaks_in(clock.series[1]), 1) << "the minimum delays";
  EXPECT_EQ(breaks_in(clock.series[2]), 1) << "the fitted deviation";
  const auto facts = mirror_facts(track.stamps());
  ASSERT_TRUE(facts);
  const Plot mirror = mirror_plot("laser1", *facts, 0.02);
  EXPECT_EQ(breaks_in(mirror.series[0]), 1);
  EXPECT_NEAR(mirror.series[0].x.back(), 12 + 30 + 8, 0.4) << "[s] recording time, including the pause";
}

TEST(ClockStamps, EstimateAMirrorsPeriod) {
  StampTrack passes;
  constexpr double kPeriod_us = 20'114.5;
  for (int k = 0; k < 200; ++k) {
    const auto at = static_cast<std::uint32_t>(kPeriod_us * k);
    passes.add(static_cast<std::uint16_t>(k), at, kEpoch_ns + std::int64_t{at} * 1000);
  }
  const auto facts = mirror_facts(passes.stamps());
  ASSERT_TRUE(facts);
  EXPECT_NEAR(facts->period, kPeriod_us * 1e-6, 1e-8);
  EXPECT_LT(facts->wander, 1e-5);
  const Gain gain = gain_over_nominal(*facts, 0.02, 1);
  EXPECT_NEAR(gain.before, 114.5e-6, 1e-7);
  EXPECT_LT(gain.after, 1e-6);
  EXPECT_TRUE(gain.significant_decrease());
  EXPECT_GT(gain.explained(), 0.99);
  EXPECT_LT(gain_over_nominal(*facts, facts->period, 1).before, 1e-7) << "resolution of the stamps";
}

TEST(ClockStamps, EstimateAMirrorsPeriodOnTheHubsClock) {
  StampTrack passes;
  for (int k = 0; k < 500; ++k) {  // a mirror at its nominal rate, on a clock that is 150 ppm slow
    const auto hub_us = 20'000.0 * k;
    passes.add(static_cast<std::uint16_t>(k), static_cast<std::uint32_t>(hub_us / (1 + 150e-6)),
               kEpoch_ns + static_cast<std::int64_t>(1000 * hub_us));
  }
  const auto own = mirror_facts(passes.stamps());
  ASSERT_TRUE(own);
  EXPECT_NEAR(own->period, 0.02 / (1 + 150e-6), 1e-8);
  const ClockFacts clock{.skew = 150e-6, .skew_std_error = 10e-6};
  const MirrorFacts facts = on_hubs_clock(*own, clock);
  EXPECT_NEAR(facts.period, 0.02, 1e-8);
  EXPECT_NEAR(facts.period_std_error, 10e-6 * 0.02, 1e-9);
  EXPECT_LT(gain_over_nominal(facts, 0.02, 1).before, 1e-7);
  EXPECT_EQ(on_hubs_clock(*own, {}).period, own->period) << "its skew is unknown";
}

TEST(ClockStamps, OfAMirrorAcrossARestartAreSkipped) {
  StampTrack passes;
  std::int64_t hub_us = 0;
  for (const std::uint16_t first : {50'000, 0}) {  // the device restarts after a second and a half
    const auto begin_us = hub_us;
    for (int k = 0; k < 100; ++k, hub_us += 20'000) {
      passes.add(static_cast<std::uint16_t>(first + k), static_cast<std::uint32_t>(hub_us - begin_us),
                 kEpoch_ns + hub_us * 1000);
    }
    hub_us += 1'500'000;
  }
  EXPECT_EQ(unbroken_segments(passes.stamps()).size(), 2U);
  const auto facts = mirror_facts(passes.stamps());
  ASSERT_TRUE(facts);
  EXPECT_NEAR(facts->period, 0.02, 1e-9);
  EXPECT_LT(facts->wander, 1e-6);
}

TEST(ClockStamps, OfAMirrorAcrossAClockStepAreSkipped) {
  StampTrack passes;
  for (int k = 0; k < 200; ++k) {
    const int step_us = k < 101 ? 0 : 1000;
    passes.add(static_cast<std::uint16_t>(k), static_cast<std::uint32_t>(20'000 * k + step_us),
               kEpoch_ns + k * 20'000'000LL);
  }
  EXPECT_GT(mirror_facts(passes.stamps())->wander, 1e-4);
  const ClockDeparture step{
      .kind = ClockDeparture::Kind::clock_step, .size = 1e-3, .at = 2.02, .at_std_error = 0.02};
  const auto facts = mirror_facts(passes.stamps(), clock_step_interval(step));
  ASSERT_TRUE(facts);
  EXPECT_NEAR(facts->period, 0.02, 1e-9);
  EXPECT_LT(facts->wander, 1e-6);
}

TEST(ClockStamps, AreInsufficientIfFew) {
  StampTrack few;
  for (int k = 0; k < 9; ++k) {
    few.add(static_cast<std::uint16_t>(k), static_cast<std::uint32_t>(20'000 * k),
            kEpoch_ns + k * 20'000'000);
  }
  for (const double fact : {clock_facts(few.stamps()).skew, clock_facts(few.stamps()).skew_std_error,
                            clock_facts(few.stamps()).delay_median, clock_facts(few.stamps()).delay_95}) {
    EXPECT_TRUE(std::isnan(fact));
  }
  EXPECT_FALSE(mirror_facts(few.stamps()));
  EXPECT_FALSE(mirror_facts({}));
}

}  // namespace
}  // namespace crisp
