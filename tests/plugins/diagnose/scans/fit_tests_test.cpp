// SPDX-License-Identifier: BSD-3-Clause
// Fit tests have uniform p-values under their models, and detect deviations.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "plugins/diagnose/scans/pass_fit_test.hpp"
#include "plugins/diagnose/scans/stationary_fit_test.hpp"
#include "plugins/diagnose/scans/sweep_fit_test.hpp"
#include "tests/plugins/diagnose/scans/tilting_scene.hpp"
#include "tests/support/kolmogorov.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;
using test::TiltingScene;

struct HiddenAtRest {
  double shift = 0;   ///< [beams] excess direction of every other scan
  double offset = 0;  ///< [m] excess range of every other scan
  double fourth = 0;  ///< [m] excess range of every fourth scan
};

constexpr std::uint16_t kScansAtRest = 120;

std::vector<SeriesScan> stationary(const HiddenAtRest& rest, std::uint64_t seed) {
  TiltingScene scene(0.005, seed);
  ScanSeries series;
  for (std::uint16_t i = 0; i < kScansAtRest; ++i) {
    const bool other = i % 2 == 1;
    auto scan =
        scene.scan((60 + static_cast<double>(seed % 20)) * kDegree, (20 + (other ? rest.shift : 0)) * kDegree,
                   other ? 140 : 141, i, TiltingScene::kPeriod * i);
    for (float& range : scan->echoes[0].ranges) {
      range += static_cast<float>((other ? rest.offset : 0) + (i % 4 == 3 ? rest.fourth : 0));
    }
    series.add(std::move(scan));
  }
  return series.scans();
}

GoodnessOfFit estimates_of(const HiddenAtRest& rest, std::uint64_t seed) {
  const auto scans = stationary(rest, seed);
  const auto interleave = find_interleave(scans, seed);
  std::vector<bool> is_moved(interleave.period);
  if (rest.shift != 0) is_moved.at(1) = true;
  return stationary_fit_test("laser1", scans, interleave, is_moved, seed).value();
}

TEST(StationaryFitTest, HasUniformPValuesForIdenticalScans) {
  std::vector<double> chances;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const GoodnessOfFit reported = estimates_of({}, seed);
    chances.push_back(reported.before.p_value);
    EXPECT_EQ(reported.after.p_value, reported.before.p_value) << "no interleave was identified";
  }
  EXPECT_LT(test::unevenness(chances), test::kUnevenOnceInAThousand) << test::in_words(chances);
}

TEST(StationaryFitTest, HasUniformPValuesForAModeledInterleave) {
  std::vector<double> chances;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const GoodnessOfFit reported = estimates_of({.shift = 0.5}, seed);
    EXPECT_LT(reported.before.p_value, 0.001);
    EXPECT_GT(reported.before.tests.at(0).amplitude, 10 * reported.after.tests.at(0).amplitude);
    chances.push_back(reported.after.p_value);
  }
  EXPECT_LT(test::unevenness(chances), test::kUnevenOnceInAThousand) << test::in_words(chances);
}

TEST(StationaryFitTest, DetectsWhatTheInterleaveDoesNotExplain) {
  const GoodnessOfFit longer = estimates_of({.shift = 0.5, .offset = 0.004}, 1);
  EXPECT_LT(longer.before.p_value, 0.01);
  EXPECT_LT(longer.after.p_value, 0.01);
  const GoodnessOfFit fourth = estimates_of({.shift = 0.5, .fourth = 0.004}, 1);
  EXPECT_LT(fourth.after.p_value, 0.01) << "scans of one class differ";
  const GoodnessOfFit unnamed = estimates_of({.offset = 0.004}, 1);
  EXPECT_LT(unnamed.before.p_value, 0.01);
  EXPECT_EQ(unnamed.after.p_value, unnamed.before.p_value);
}

TEST(StationaryFitTest, NeedsEnoughScans) {
  auto scans = stationary({.shift = 0.5}, 1);
  scans.resize(12);
  EXPECT_FALSE(stationary_fit_test("laser1", scans, {.period = 2}, {false, true}, 1));
}

/// A sweep of 60°/s with evenly taken scans, except every other that is `late`.
struct TimedSweep {
  explicit TimedSweep(std::uint64_t seed, double late = 0) {
    TiltingScene scene(0.005, seed);
    const double start = 20 * kDegree + 1 * kDegree * static_cast<double>(seed % 10);
    for (std::uint16_t i = 0; i < 90; ++i) {
      const double time = TiltingScene::kPeriod * i;
      const double taken = time + (i % 2 == 1 ? late : 0);
      series.add(test::reading_at(start + 60 * kDegree * time, time));
      series.add(scene.scan(start + 60 * kDegree * taken, 20 * kDegree, 140, i, time));
      stamps.push_back(time);
    }
  }
  double p_value(const std::vector<double>& times, const std::vector<double>& delays) const {
    const std::vector<double> angles(times.size(), 20 * kDegree);
    const auto scores =
        scan_scores(series.scans(), times, angles, series.actuator({.counts_per_revolution = 360000}));
    return sweep_fit_test(series.scans(), scores, delays, 1).value().p_value;
  }
  ScanSeries series;
  std::vector<double> stamps;
};

/// Receipt times of scans that arrive in pairs.
std::vector<double> in_pairs(std::vector<double> times) {
  for (std::size_t i = 1; i < times.size(); i += 2) times[i - 1] = times[i] - 0.001;
  return times;
}

std::vector<double> less(std::vector<double> times, const std::vector<double>& others) {
  for (std::size_t i = 0; i < times.size(); ++i) times[i] -= others[i];
  return times;
}

TEST(SweepFitTest, HasUniformPValuesForCorrectTimes) {
  std::vector<double> chances;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const TimedSweep sweep(seed);
    std::mt19937_64 random(seed);
    std::exponential_distribution<double> delay(1 / 0.004);
    std::vector<double> delays;
    for (std::size_t i = 0; i < sweep.stamps.size(); ++i) delays.push_back(delay(random));
    chances.push_back(sweep.p_value(sweep.stamps, delays));
  }
  EXPECT_LT(test::unevenness(chances), test::kUnevenOnceInAThousand) << test::in_words(chances);
}

TEST(SweepFitTest, HasUniformPValuesForStampsOfBursts) {
  std::vector<double> chances;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const TimedSweep sweep(seed);
    const auto receipts = in_pairs(sweep.stamps);
    const auto delays = less(receipts, sweep.stamps);
    EXPECT_LT(sweep.p_value(receipts, delays), 0.005);
    chances.push_back(sweep.p_value(sweep.stamps, delays));
  }
  EXPECT_LT(test::unevenness(chances), test::kUnevenOnceInAThousand) << test::in_words(chances);
}

TEST(SweepFitTest, DetectsScansWithWrongStamps) {
  const TimedSweep sweep(1, 0.002);
  std::mt19937_64 random(1);
  std::vector<double> delays(sweep.stamps.size());
  std::ranges::shuffle(delays, random);
  for (double& delay : delays) delay = 1e-3 * static_cast<double>(random() % 100);
  EXPECT_LT(sweep.p_value(sweep.stamps, delays), 0.01) << "not along their delays, but alternately";
}

constexpr double kStepOfTilt = 0.1 * kDegree;

/// Up from 30° and down again, one step per scan, `between` the steps of the upward pass. On the downward
/// pass the tilt is smaller than its reading by `behind` at the lowest reading, and by `more` in addition at
/// the highest.
struct Ways {
  double behind = 0, more = 0, between = 0;  ///< [rad]
};

PassOffset shift_of(const Ways& ways, std::uint64_t seed) {
  ScanSeries series;
  TiltingScene scene(0.01, seed);
  constexpr int kSteps = 400;
  for (int i = 0; i < 2 * kSteps; ++i) {
    const bool up = i <= kSteps;
    const int at = up ? i : 2 * kSteps - i;
    const double read = 30 * kDegree + at * kStepOfTilt + (up ? 0 : ways.between);
    const double tilt = read - (up ? 0 : ways.behind + ways.more * at / kSteps);
    series.add(test::reading_at(read, 0.1 * i));
    series.add(scene.scan(tilt, 20 * kDegree, 140, static_cast<std::uint16_t>(i), 0.1 * i));
  }
  const auto passes = find_passes(series, series.actuator({.counts_per_revolution = 360000}), 5 * kDegree);
  return find_shift(passes.at(0), passes.at(1), seed);
}

TEST(PassFitTest, HasUniformPValuesWithoutHysteresis) {
  std::vector<double> chances;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const double between = static_cast<double>(seed % 4) * kStepOfTilt / 4;
    chances.push_back(pass_fit_test(shift_of({.between = between}, seed), false).before.p_value);
  }
  EXPECT_LT(test::unevenness(chances), test::kUnevenOnceInAThousand) << test::in_words(chances);
}

TEST(PassFitTest, HasUniformPValuesForAModeledBacklash) {
  std::vector<double> chances;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const GoodnessOfFit reported = pass_fit_test(shift_of({.behind = 2 * kStepOfTilt}, seed), true);
    EXPECT_LT(reported.before.p_value, 1e-6);
    chances.push_back(reported.after.p_value);
  }
  EXPECT_LT(test::unevenness(chances), test::kUnevenOnceInAThousand) << test::in_words(chances);
}

TEST(PassFitTest, DetectsAnInhomogeneousShift) {
  const GoodnessOfFit reported = pass_fit_test(shift_of({.more = 2.5 * kStepOfTilt}, 1), true);
  EXPECT_LT(reported.before.p_value, 1e-6);
  EXPECT_LT(reported.after.p_value, 0.001);
}

}  // namespace
}  // namespace crisp
