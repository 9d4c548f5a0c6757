// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/encoder_slips.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <crisp/findings.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/clocks/angle_shifts.hpp"
#include "plugins/diagnose/clocks/encoder_stage.hpp"
#include "tests/support/stage_driver.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;
using namespace crisp::estimate;
using namespace crisp::statistics;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

struct Step {
  double at = 0;    // [s]
  double by = 0;    // [rad]
  double over = 0;  // [s] duration of the slip
};

/// A laser of 100 beams and 50 scans per second on a plate that turns about once per second. Its ranges are a
/// smooth function of both angles, as of any scene.
struct Turning {
  std::vector<Step> steps = {};
  double eccentricity = 0;  // [rad]
  double lag = 0;           // [s]
  double noise = 0.01;      // [m]
  double seconds = 8;
  std::uint64_t seed = 1;

  static double plate(double t) { return 6.0 * t + 1.5 * std::sin(1.3 * t); }  // [rad]

  double encoder(double t) const {
    double angle = plate(t) + eccentricity * std::sin(plate(t));
    for (const Step& step : steps) {
      if (t < step.at) continue;
      angle += step.by * (step.over > 0 ? std::min(1.0, (t - step.at) / step.over) : 1);
    }
    return angle;
  }

  Sample sample() {
    std::mt19937_64 random(seed);
    std::normal_distribution<> error(0, noise);
    Sample made;
    constexpr int kBeams = 100;
    for (int scan = 0; scan < static_cast<int>(50 * seconds); ++scan) {
      for (int beam = 0; beam < kBeams; ++beam) {
        const double t = 0.02 * (scan + 0.75 * beam / kBeams);
        const double theta = (270.0 * beam / kBeams - 135) * kDegree;
        const double phi = plate(t + lag);
        made.beams.range.push_back(static_cast<float>(4 + std::sin(phi + theta) + std::cos(2 * phi - theta) +
                                                      0.5 * std::sin(3 * phi) + error(random)));
        made.beams.mirror_angle.push_back(static_cast<float>(theta));
        made.beams.time.push_back(t);
        made.beams.laser.push_back(0);
        made.beams.remission.push_back(0);
        made.beams.beam.push_back(static_cast<std::uint16_t>(beam));
      }
    }
    std::vector<double> times;
    std::vector<double> angles;
    for (double t = -0.5; t < seconds + 0.5; t += 0.002) {
      times.push_back(t);
      angles.push_back(encoder(t));
    }
    trajectory = PlateTrajectory(0, times, angles, 0.1);
    made.plate = &trajectory;
    return made;
  }

  PlateTrajectory trajectory;
};

EncoderSlips slips_of(Turning turning) {
  const Sample sample = turning.sample();
  return find_encoder_slips(sample.beams, *sample.plate, 0.02 * kDegree, 1);
}

TEST(AngleShifts, MeasureTheErrorOfTheCountBetweenPasses) {
  Turning turning{.steps = {{.at = 4, .by = 2 * kDegree}}};
  const Sample sample = turning.sample();
  std::vector<double> across;
  std::vector<double> given;
  for (const AngleShift& shift : angle_shifts(sample.beams, *sample.plate)) {
    EXPECT_LT(shift.earlier, shift.later);
    if (std::abs(shift.earlier - 4) < 0.2 || std::abs(shift.later - 4) < 0.2) continue;
    const bool is_across = shift.earlier < 4 && shift.later > 4;
    (is_across ? across : given).push_back(shift.shift);
  }
  ASSERT_GT(across.size(), 20U);
  EXPECT_NEAR(median_in_place(across), 2 * kDegree, 0.05 * kDegree);
  EXPECT_NEAR(median_in_place(given), 0, 0.02 * kDegree);
}

TEST(AngleShifts, AreEmptyWithoutRepeatedPasses) {
  Turning turning{.seconds = 0.8};
  const Sample sample = turning.sample();
  EXPECT_THAT(angle_shifts(sample.beams, *sample.plate), IsEmpty());
}

TEST(EncoderSlips, AreEstimatedWithTheirSizeAndTime) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto found =
        slips_of({.steps = {{.at = 3.2011, .by = -1.5 * kDegree}}, .lag = 0.014, .seed = seed});
    ASSERT_THAT(found.slips, SizeIs(1)) << seed;
    const EncoderSlip& slip = found.slips.front();
    EXPECT_NEAR(slip.by, -1.5 * kDegree, 4 * slip.by_std_error);
    EXPECT_LT(slip.by_std_error, 0.02 * kDegree) << "as the readings show it";
    EXPECT_NEAR(slip.at, 3.2011, 0.003);
    EXPECT_TRUE(slip.is_in_readings);
    EXPECT_LT(found.ci95[1], 0);
    EXPECT_LT(found.rms_after, 0.3 * found.rms_before);
  }
}

TEST(EncoderSlips, AreFoundOneByOne) {
  const auto found = slips_of(
      {.steps = {
           {.at = 2.5, .by = 12 * kDegree}, {.at = 4.5, .by = 12 * kDegree}, {.at = 6, .by = -kDegree}}});
  ASSERT_THAT(found.slips, SizeIs(3));
  EXPECT_NEAR(found.slips[0].by, 12 * kDegree, 0.1 * kDegree);
  EXPECT_NEAR(found.slips[1].by, 12 * kDegree, 0.1 * kDegree);
  EXPECT_NEAR(found.slips[2].by, -kDegree, 0.1 * kDegree);
}

TEST(EncoderSlips, OfASlowCouplingMayBeTheBase) {
  const auto found = slips_of({.steps = {{.at = 4, .by = 3 * kDegree, .over = 0.3}}});
  ASSERT_FALSE(found.slips.empty());
  double sum = 0;
  for (const EncoderSlip& slip : found.slips) {
    EXPECT_FALSE(slip.is_in_readings);
    EXPECT_NEAR(slip.at, 4.15, 0.4);
    sum += slip.by;
  }
  EXPECT_NEAR(sum, 3 * kDegree, 0.3 * kDegree);
}

TEST(EncoderSlips, AreNotFoundInAnEccentricEncoderWithALag) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto found = slips_of({.eccentricity = 0.02, .lag = 0.03, .noise = 0.03, .seed = seed});
    EXPECT_THAT(found.slips, IsEmpty()) << seed;
    EXPECT_GT(found.shifts, 100U);
  }
}

TEST(EncoderSlips, AreRemovedFromTheTrajectory) {
  const PlateTrajectory plate(0, {0, 1, 2, 3}, {0, 1, 2.5, 3.5}, 2);
  const std::vector<EncoderSlip> slips = {{.at = 1.5, .by = 0.5}};
  EXPECT_THAT(without_slips(plate, slips).angles(), ElementsAre(0, 1, 2, 3));
}

TEST(DiagnoseEncoder, NamesTheSlipAndCorrectsTheTrajectory) {
  Turning turning{.steps = {{.at = 4, .by = 2 * kDegree}}};
  const Sample sample = turning.sample();
  auto stage = test::StageDriver::of<DiagnoseEncoderStage>({});
  stage.feed(sample.beams, *sample.plate);
  stage.finish();
  ASSERT_THAT(stage.given<Findings>(), SizeIs(1));
  const auto& findings = stage.given<Findings>().front()->findings;
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_EQ(findings.front().cause, "encoder.slip");
  EXPECT_TRUE(findings.front().accepted);
  EXPECT_THAT(findings.front().confounded_with, IsEmpty());
  ASSERT_THAT(stage.given<PlateTrajectory>(), SizeIs(1));
  const PlateTrajectory& plate = *stage.given<PlateTrajectory>().front();
  EXPECT_NEAR(plate.angles().back(), Turning::plate(plate.end()), 0.1 * kDegree);
}

TEST(DiagnoseEncoder, ReportsMissingRepeatedPasses) {
  Turning turning{.seconds = 0.8};
  const Sample sample = turning.sample();
  auto stage = test::StageDriver::of<DiagnoseEncoderStage>({});
  stage.feed(sample.beams, *sample.plate);
  stage.finish();
  ASSERT_THAT(stage.given<Findings>(), SizeIs(1));
  ASSERT_THAT(stage.given<Findings>().front()->unobservable, SizeIs(1));
  EXPECT_EQ(stage.given<Findings>().front()->unobservable.front().parameter, "plate.encoder.slip");
}

}  // namespace
}  // namespace crisp
