// SPDX-License-Identifier: BSD-3-Clause
// Noise of a turning scanner is identified on surfaces, and a plain scanner has no cause.
#include "plugins/diagnose/noise/surface_range_errors.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include <crisp/registrar.hpp>

#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/shared_errors.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"
#include "plugins/diagnose/noise/goodness_of_fit.hpp"
#include "plugins/diagnose/noise/noise_diagnosis.hpp"
#include "plugins/diagnose/noise/noise_model_stage.hpp"
#include "plugins/diagnose/noise/range_quantization.hpp"
#include "plugins/diagnose/scene/mixed_pixels.hpp"
#include "plugins/diagnose/scene/visibility.hpp"
#include "tests/plugins/diagnose/hidden.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;
using namespace crisp::estimate;
using namespace crisp::quality;
using namespace crisp::simulate;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kMinGain = 0.001;

double value_in(const Finding& finding, const std::string& name) {
  return std::ranges::find(finding.parameters, name, &Parameter::name)->value;
}
double error_in(const Finding& finding, const std::string& name) {
  return std::ranges::find(finding.parameters, name, &Parameter::name)->std_error;
}

/// A recording of known calibration with its beam association.
class AssociatedBeams {
 public:
  AssociatedBeams(const std::string& scene, const NoiseEffects& noise, double sigma = 0.012,
                  std::uint64_t seed = 3)
      : AssociatedBeams(record(scene, noise, sigma, seed), {}, sigma) {}
  /// @param by  calibration of the association; without lasers: the truth
  AssociatedBeams(test::Recording recording, const Calibration& by, double sigma = 0.012)
      : recording_(std::move(recording)),
        evidence_(evidence_of(recording_, by.lasers.empty() ? recording_.made.truth : by, sigma)) {
    met_ = associate_beams(evidence_.surfels(), evidence_.beams(), beams().range);
    blocks_ = recording_blocks(beams());
  }

  const Measurements& beams() const { return evidence_.sample().beams; }
  const BeamAssociation& association() const { return met_; }
  double usual() const { return usual_error(met_); }
  RangeErrors scatter() const { return scatter_of(0, beams(), met_, usual(), blocks_); }
  NoiseDiagnosis noise() const { return diagnose_noise("laser1", scatter(), 1, kMinGain); }
  std::optional<Finding> quantization() const {
    std::vector<float> ranges;
    std::vector<std::uint32_t> blocks;
    for (std::size_t i = 0; i < beams().size(); ++i) {
      if (beams().laser[i] != 0) continue;
      ranges.push_back(beams().range[i]);
      blocks.push_back(blocks_[i]);
    }
    return range_quantization("laser1", ranges, blocks, 1);
  }
  Crossings crossings() const {
    const PointsView points = evidence_.beams().points;
    return crossings_of(0, beams(), points, met_, PointDensity(points), usual(), noise().model);
  }
  ChangingDirections changing() const {
    return changing_directions(beams(), *evidence_.sample().plate, met_, usual());
  }

 private:
  static test::Recording record(const std::string& scene, const NoiseEffects& noise, double sigma,
                                std::uint64_t seed) {
    ScannerSettings scanner = test::scanner_of(seed, 10);
    scanner.range.sigma = sigma;
    scanner.laser_effects.assign(scanner.rig.lasers.size(), {.noise = noise});
    return test::recorded(scanner, built_in_scene(scene));
  }
  static SurfaceObservations evidence_of(const test::Recording& recording, const Calibration& by,
                                         double sigma) {
    const SensorModel model(by, built_in_terms());
    const LagRange lag = lag_range(model, 0);
    RefinementSettings settings;
    settings.surfels.noise = sigma;
    return {model,    covered(recording.sample(), lag.earliest, lag.latest),
            settings, std::numeric_limits<std::size_t>::max(),
            {},       SurfacesOf::kSearch};
  }

  test::Recording recording_;
  SurfaceObservations evidence_;
  BeamAssociation met_;
  std::vector<std::uint32_t> blocks_;
};

TEST(SurfaceRangeErrors, OfAPlainScannerHaveNoCause) {
  for (const char* scene : {"office", "hall", "street", "workshop"}) {
    const AssociatedBeams plain(scene, {});
    const RangeErrors scatter = plain.scatter();
    const NoiseDiagnosis noise = plain.noise();
    EXPECT_THAT(noise.findings, IsEmpty()) << scene;
    EXPECT_THAT(noise.unnamed, IsEmpty()) << scene;
    EXPECT_NEAR(noise.model.sigma(), 0.012, 0.0002) << scene;
    EXPECT_FALSE(noise_by("incidence", scatter.cosine, "laser1", scatter, noise.model, kMinGain, 1));
    EXPECT_FALSE(noise_by("remission", scatter.remission, "laser1", scatter, noise.model, kMinGain, 1));
    EXPECT_GT(goodness_of_fit("laser1", scatter, noise.model, {}, BeamsOf::kSurfaces, 1).after.p_value, 0.01)
        << scene;
    EXPECT_FALSE(plain.quantization()) << scene << ": the telegram's millimetre does not count";
    EXPECT_FALSE(mixed_pixels("laser1", plain.crossings())) << scene;
    EXPECT_FALSE(moving(plain.changing(), 1)) << scene;
  }
}

TEST(SurfaceRangeErrors, WithHeavyTailsAreNamedAndEstimated) {
  const AssociatedBeams tailed("office", {.tail_share = 0.03, .tail_scale = 5});
  const NoiseDiagnosis noise = tailed.noise();
  const auto& found = noise.findings;
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].cause, "noise.heavy_tail");
  EXPECT_TRUE(found[0].accepted);
  // 0.001: mirrored outliers and edges in the tail; four standard errors of 3 % of 180 000 ranges.
  EXPECT_NEAR(value_in(found[0], "share"), 0.03, 4 * error_in(found[0], "share") + 0.001);
  EXPECT_NEAR(value_in(found[0], "scale"), 5, 4 * error_in(found[0], "scale") + 0.1);
  const GoodnessOfFit reported =
      goodness_of_fit("laser1", tailed.scatter(), noise.model, {}, BeamsOf::kSurfaces, 1);
  EXPECT_LT(reported.before.p_value, 1e-100);
  EXPECT_GT(reported.after.p_value, 1e-4) << "mirrored outliers deviate";
}

TEST(SurfaceRangeErrors, ReplaceFarTooShortOnesByMirroredLongOnes) {
  // On a wall 3 m away, every tenth range is wrong by six standard deviations. Three are too long per one too
  // short, or three too short per one too long, as thin foreground objects make them.
  for (const double sign : {1.0, -1.0}) {
    Measurements beams;
    BeamAssociation association;
    for (std::uint16_t beam = 0; beam < 50; ++beam) {
      const bool is_far = beam % 10 == 5 && beam < 45;
      const double error = is_far ? sign * (beam == 15 ? -0.06 : 0.06) : 0;
      beams.laser.push_back(0);
      beams.beam.push_back(beam);
      beams.range.push_back(static_cast<float>(3 + error));
      beams.remission.push_back(50);
      association.ahead.push_back(0);
      association.place.push_back(0);
      association.error.push_back(static_cast<float>(error));
      association.cosine.push_back(1);
    }
    const RangeErrors errors = scatter_of(0, beams, association, 0.01, std::vector<std::uint32_t>(50, 0));
    constexpr std::size_t kNear = 48 - 3 * 4;  // with neighbours on the wall on either side
    EXPECT_EQ(errors.size(), kNear + (sign > 0 ? 6 : 2));
    const auto far = [&](double size) {
      return std::ranges::count_if(errors.value,
                                   [&](float error) { return std::abs(double{error} - size) < 1e-6; });
    };
    EXPECT_EQ(far(0.06), sign > 0 ? 3 : 1);
    EXPECT_EQ(far(-0.06), far(0.06));
  }
}

/// Mean squared error of the stage's slope of 0.0025 in units of its standard error, over recordings.
double mean_square_off_slope(std::uint64_t seeds) {
  constexpr double kSlope = 0.0025;
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    auto stage = test::StageDriver::of<DiagnoseNoiseModelStage>({});
    TermRegistry terms = built_in_terms();
    Registrar registrar;
    registrar.attach(terms);
    stage.run().registrar = &registrar;
    ScannerSettings scanner = test::scanner_of(seed, 10);
    scanner.laser_effects.resize(3);
    scanner.laser_effects[1].noise = {.slope = kSlope};
    const test::Recording recording =
        test::recorded(scanner, built_in_scene(seed % 2 == 0 ? "hall" : "street"));
    stage.feed(recording.made.beams, recording.made.plate, recording.made.truth);
    stage.finish();
    const auto found = stage.given<Findings>();
    if (found.size() != 1 || found[0]->findings.size() != 1) return HUGE_VAL;
    const Finding& finding = found[0]->findings[0];
    const double off = (value_in(finding, "slope") - kSlope) / error_in(finding, "slope");
    squares += off * off / static_cast<double>(seeds);
  }
  return squares;
}

TEST(SurfaceRangeErrors, OfDistantSurfacesHaveNoSelectionBias) {
  // 19/17 is the mean square of Student's t of twenty groups; its relative standard deviation over six is
  // √(2/6).
  EXPECT_LT(mean_square_off_slope(6), 19 / 17.0 * (1 + 3 * std::sqrt(2 / 6.0)));
}

TEST(SurfaceRangeErrors, ArePlottedByTheStageForEachLaser) {
  const test::TemporaryFolder folder;
  auto stage =
      test::StageDriver::of<DiagnoseNoiseModelStage>({{"folder", OptionScalar(folder.path().string())}});
  TermRegistry terms = built_in_terms();
  Registrar registrar;
  registrar.attach(terms);
  stage.run().registrar = &registrar;
  ScannerSettings scanner = test::scanner_of(3, 4);
  scanner.laser_effects.resize(3);
  scanner.laser_effects[1].noise = {.tail_share = 0.03, .tail_scale = 5};
  const test::Recording recording = test::recorded(scanner, office());
  stage.feed(recording.made.beams, recording.made.plate, recording.made.truth);
  stage.finish();
  EXPECT_THAT(stage.report().written,
              testing::ElementsAre(folder / "laser1_noise.svg", folder / "laser2_noise.svg",
                                   folder / "laser3_noise.svg"));
  const auto found = stage.given<Findings>();
  ASSERT_THAT(found, SizeIs(1));
  ASSERT_THAT(found[0]->findings, SizeIs(1));
  EXPECT_EQ(found[0]->findings[0].scope, "laser2");
  EXPECT_EQ(found[0]->findings[0].explained_fraction, 1) << "there is no other component";
  EXPECT_GT(found[0]->findings[0].log10_bayes_factor, 10);
}

/// Expects one cause of the scene's noise, with this parameter.
void expect_named(const std::string& scene, const NoiseEffects& noise, const std::string& cause,
                  const std::string& parameter, double value) {
  const auto found = AssociatedBeams(scene, noise).noise().findings;
  ASSERT_THAT(found, SizeIs(1)) << scene;
  EXPECT_EQ(found[0].cause, cause) << scene;
  EXPECT_TRUE(found[0].accepted) << scene;
  EXPECT_NEAR(value_in(found[0], parameter), value, 4 * error_in(found[0], parameter)) << scene;
}

TEST(SurfaceRangeErrors, DependingOnRangeAreNamedAndEstimated) {
  expect_named("hall", {.slope = 0.0015}, "noise.range_dependent", "slope", 0.0015);
}

TEST(SurfaceRangeErrors, DependingOnIncidenceAreNamedAndEstimated) {
  expect_named("office", {.spread = 0.008}, "noise.incidence_dependent", "spread", 0.008);
  expect_named("street", {.spread = 0.008}, "noise.incidence_dependent", "spread", 0.008);
}

TEST(SurfaceRangeErrors, DependingOnRemissionAreNamedAndEstimated) {
  expect_named("office", {.jitter = 0.08}, "noise.remission_dependent", "jitter", 0.08);
  expect_named("hall", {.jitter = 0.08}, "noise.remission_dependent", "jitter", 0.08);
}

TEST(SurfaceRangeErrors, DependingOnIncidenceAndRemissionAreNamedAsBoth) {
  const auto found = AssociatedBeams("office", {.spread = 0.008, .jitter = 0.08}).noise().findings;
  std::vector<std::string> causes;
  for (const Finding& finding : found) causes.push_back(finding.cause);
  EXPECT_THAT(causes,
              testing::UnorderedElementsAre("noise.incidence_dependent", "noise.remission_dependent"));
}

TEST(SurfaceRangeErrors, OfAnIncompleteSensorModelAreNoNoise) {
  for (const char* scene : {"office", "hall", "street"}) {
    auto turned = test::hidden(3, 10, built_in_scene(scene), {{"encoder.eccentricity", {0.004}}});
    Calibration without = turned.made.truth;
    without.plate_terms.clear();
    const NoiseDiagnosis noise = AssociatedBeams(std::move(turned), without).noise();
    for (const Finding& finding : noise.findings) {
      EXPECT_FALSE(finding.accepted) << scene << ": " << finding.cause;
      EXPECT_THAT(finding.rejection, testing::HasSubstr("neighbouring beams"))
          << scene << ": " << finding.cause;
    }
  }
}

TEST(SurfaceRangeErrors, WithTwoPeaksAreNamedAndEstimated) {
  const auto found = AssociatedBeams("office", {.separation = 0.015}, 0.005).noise().findings;
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].cause, "noise.two_peaks");
  EXPECT_NEAR(value_in(found[0], "separation"), 0.015, 2e-4) << "RMS bumps of the surfaces";
}

TEST(SurfaceRangeErrors, OfQuantizedRangesAreNamedWithTheStep) {
  for (const double step : {0.01, 0.0025}) {
    const auto found = AssociatedBeams("office", {.step = step}).quantization();
    ASSERT_TRUE(found) << step;
    EXPECT_NEAR(value_in(*found, "step"), step, 1e-6);
    EXPECT_TRUE(found->accepted);
  }
}

TEST(SurfaceRangeErrors, OfMixedPixelsAreNamed) {
  const NoiseEffects spot{.divergence = 0.014, .aperture = 0.008};
  for (const char* scene : {"office", "workshop"}) {
    EXPECT_TRUE(mixed_pixels("laser1", AssociatedBeams(scene, spot).crossings())) << scene;
  }
  EXPECT_LT(AssociatedBeams("workshop", {}).crossings().share(), 0.03) << "cluttered, with narrow spots";
}

TEST(SurfaceRangeErrors, OfGrazingBeamsAreNotTakenForMixedPixels) {
  // Beyond 60°, where the diagnosis does not measure noise, a spread of 9 mm makes errors of up to 9 cm.
  EXPECT_FALSE(mixed_pixels("laser1", AssociatedBeams("street", {.spread = 0.009}).crossings()));
  EXPECT_TRUE(mixed_pixels(
      "laser1",
      AssociatedBeams("office", {.spread = 0.009, .divergence = 0.014, .aperture = 0.008}).crossings()))
      << "mixed pixels are still detected without grazing incidence";
}

TEST(SurfaceRangeErrors, OfMovingPeopleAreNamed) {
  for (std::uint64_t seed = 3; seed <= 6; ++seed) {
    EXPECT_TRUE(moving(AssociatedBeams("people", {}, 0.012, seed).changing(), 1)) << seed;
    EXPECT_FALSE(moving(AssociatedBeams("workshop", {}, 0.012, seed).changing(), 1))
        << seed << ": cluttered, but static";
  }
  EXPECT_FALSE(moving(AssociatedBeams("garden", {}).changing(), 1)) << "moving leaves";
}

}  // namespace
}  // namespace crisp
