// SPDX-License-Identifier: BSD-3-Clause
// Numbers worked out by hand from docs/effects.md for terms that correct times and ranges.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/pipeline/model/terms_support.hpp"

namespace crisp {
namespace {

using namespace crisp::data;

/// By how much the term lengthens a range of r [m], for a beam that points down.
double lengthened(const std::string& term, const std::map<std::string, double>& given, Measurements beam) {
  const auto x = point_with(term, given, one_laser(0, 0, 0), beam, turning_plate(0));
  return -x.z() - static_cast<double>(beam.range[0]);
}

/// How much further the plate is for a beam at t = 1 s, in seconds of its 2 rad/s.
double later(const std::string& term, const std::map<std::string, double>& given, const Measurements& beam) {
  const auto plate = turning_plate(0.3, 2);
  const auto with = point_with(term, given, one_laser(0, 1, 0), beam, plate);
  const Eigen::Vector3d without = SensorModel(one_laser(0, 1, 0)).place(beam, plate).points.col(0);
  return (std::atan2(with.y(), with.x()) - std::atan2(without.y(), without.x())) / 2;
}

TEST(TimingTerms, TheTimeBetweenBeamsAddsUpAlongTheScan) {
  Measurements beam = one_beam(1, 0);
  beam.beam = {540};
  EXPECT_NEAR(later("timing.intra_scan", {{"kappa", 20e-3 / 720}}, beam), 0.015, 1e-9);
}

TEST(TimingTerms, AnExcessOfTheMirrorsPeriodStretchesTheTurn) {
  EXPECT_NEAR(later("mirror.period", {{"excess", 120e-6}}, one_beam(1, std::numbers::pi)), 60e-6, 1e-9);
  EXPECT_NEAR(later("mirror.period", {{"excess", 120e-6}}, one_beam(1, -std::numbers::pi / 2)), -30e-6, 1e-9);
}

TEST(TimingTerms, AClockThatDriftsIsLateByTheSquareOfTheTime) {
  Measurements beam = one_beam(1, 0);
  beam.time = {1.5};
  EXPECT_NEAR(later("clock.drift", {{"drift", 4e-4}}, beam), 4e-4 * 1.5 * 1.5 / 2, 1e-9);
  EXPECT_NEAR(later("clock.drift", {{"skew", 2e-4}}, beam), 3e-4, 1e-9);
}

TEST(RangeTerms, AnOffsetAndAScaleAddToTheRange) {
  EXPECT_NEAR(lengthened("range.offset", {{"c", 0.03}}, one_beam(4, 0)), 0.03, kFloat);
  EXPECT_NEAR(lengthened("range.scale", {{"s", 0.003}}, one_beam(4, 0)), 0.012, kFloat);
}

TEST(RangeTerms, IncidenceIsWhatLaconteAndOthersMeasured) {
  // 5 m away: 6 mm at 60°, 14 mm at 70°, 46 mm at 80°, each to their millimetre's half.
  const auto at = [](double degrees) {
    Measurements beam = one_beam(5, 0);
    beam.cos_incidence = {static_cast<float>(std::cos(degrees * kDegree))};
    return lengthened("range.incidence", {{"c", 0.047}}, beam);
  };
  EXPECT_NEAR(at(60), 0.006, 5e-4);
  EXPECT_NEAR(at(70), 0.014, 5e-4);
  EXPECT_NEAR(at(80), 0.046, 5e-4);
  EXPECT_NEAR(at(0), 0, 1e-9);
}

TEST(RangeTerms, IncidenceDoesNothingWhereNobodyKnowsIt) {
  EXPECT_EQ(lengthened("range.incidence", {{"c", 0.5}}, one_beam(5, 0)),
            lengthened("range.offset", {}, one_beam(5, 0)));
}

TEST(RangeTerms, IncidenceStaysFiniteWhereASurfaceIsSeenFromItsEdge) {
  Measurements beam = one_beam(5, 0);
  beam.cos_incidence = {0};
  const double edge = lengthened("range.incidence", {{"c", 0.047}}, beam);
  EXPECT_GT(edge, 0.1);
  EXPECT_LT(edge, 0.5);
}

TEST(RangeTerms, TheWalkFollowsTheLogarithmOfTheRemission) {
  Measurements beam = one_beam(5, 0);
  beam.remission = {static_cast<float>(100 / std::numbers::e)};  // u = −1
  EXPECT_NEAR(lengthened("range.intensity", {{"a", 0.004}, {"b", 0.001}}, beam), -0.003, kFloat);
  beam.remission = {100};
  EXPECT_NEAR(lengthened("range.intensity", {{"a", 0.004}, {"b", 0.001}}, beam), 0, kFloat);
  beam.remission = {0};
  EXPECT_NEAR(lengthened("range.intensity", {{"a", 0.004}, {"b", 0.001}}, beam), 0, kFloat) << "unknown";
}

TEST(RangeTerms, ACyclicErrorHasItsPeriod) {
  // 4.25 m are 8.5 periods: sin = 0, cos = −1; an eighth of a period on, both are −1/√2.
  const std::map<std::string, double> given = {{"a", 0.003}, {"b", 0.005}, {"P", 0.5}};
  EXPECT_NEAR(lengthened("range.cyclic", given, one_beam(4.25, 0)), -0.005, kFloat);
  EXPECT_NEAR(lengthened("range.cyclic", given, one_beam(4.3125, 0)), -0.008 / std::sqrt(2), kFloat);
}

TEST(RangeTerms, WarmingUpApproachesItsEndByAFactorEInEachTimeConstant) {
  const auto after = [](double t) {
    Measurements beam = one_beam(5, 0);
    beam.time = {t};
    return lengthened("range.warmup", {{"c", 0.02}, {"T", 0.5}}, beam);
  };
  EXPECT_NEAR(after(0), 0, kFloat);
  EXPECT_NEAR(after(0.5), 0.02 * (1 - 1 / std::numbers::e), kFloat);
  EXPECT_NEAR(after(2), 0.02 * (1 - std::pow(std::numbers::e, -4)), kFloat);
}

TEST(RangeTerms, AStepIsThereFromItsInstantOn) {
  const auto after = [](double t) {
    Measurements beam = one_beam(5, 0);
    beam.time = {t};
    return lengthened("range.step", {{"h", -0.00205}, {"at", 1.2}}, beam);
  };
  EXPECT_NEAR(after(1.18), 0, kFloat);
  EXPECT_NEAR(after(1.2), -0.001025, kFloat);
  EXPECT_NEAR(after(1.22), -0.00205, kFloat);
}

}  // namespace
}  // namespace crisp
