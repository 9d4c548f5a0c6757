// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/found_effects.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>

#include <crisp/error.hpp>

#include "grabbers/simulate/device_effects.hpp"
#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/scenes.hpp"

namespace crisp {
namespace {

using namespace crisp::simulate;
using testing::ElementsAre;
using testing::HasSubstr;

Finding finding(const std::string& cause, const std::string& scope, std::vector<Parameter> parameters) {
  return {.cause = cause, .scope = scope, .parameters = std::move(parameters), .accepted = true};
}

/// Laser 2 scatters about two values, which each of its beams has equally often; the plate's clock is known,
/// and laser 3's mirror keeps its rate by a clock that is slow.
Findings some() {
  Findings all;
  all.findings = {finding("noise.two_peaks", "laser2",
                          {{.name = "separation", .unit = "m", .value = 15e-3},
                           {.name = "least", .unit = "1", .value = 0.5},
                           {.name = "most", .unit = "1", .value = 0.5}})};
  all.noise = {{.laser = "laser2", .ranges = 1000, .sigma = 5e-3}};
  all.devices = {{.device = "plate", .stamps = 500, .skew = 80e-6, .delay_median = 1e-4},
                 {.device = "laser3", .skew = 200e-6, .period = 0.02, .nominal_period = 0.02}};
  return all;
}

class FoundEffectsTest : public testing::Test {
 protected:
  FoundEffectsTest() { register_built_in(terms_); }
  FoundEffects effects(const Findings& findings) const {
    return effects_of(findings, "diagnosis.json", rig_, recording_catalogue(terms_));
  }
  RecordingSettings settings_with(const Findings& findings) const {
    RecordingSettings settings;
    apply_device_effects(effects(findings).effects, settings);
    return settings;
  }
  std::string complaint(const Findings& findings) const {
    try {
      effects(findings);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  }
  TermRegistry terms_;
  Rig rig_ = default_rig();
};

/// Standard deviations [m] of the lasers' ranges, of beams that meet the same spot again and again.
std::vector<double> spreads_at_rest(ScannerSettings settings) {
  settings.motion = {.kind = MotionKind::constant, .max_rate = 0};
  settings.mirror.wander = 0;
  settings.duration = 2;
  const Measurements beams = simulate_measurements(settings, built_in_scene("office")).beams;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<double>> of;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    of[{beams.laser[i], beams.beam[i]}].push_back(double{beams.range[i]});
  }
  std::vector<double> squares(settings.rig.lasers.size());
  std::vector<double> free(settings.rig.lasers.size());
  for (const auto& [beam, ranges] : of) {
    double sum = 0;
    for (const double range : ranges) sum += range;
    for (const double range : ranges) {
      squares[beam.first] += std::pow(range - sum / static_cast<double>(ranges.size()), 2);
    }
    free[beam.first] += static_cast<double>(ranges.size()) - 1;
  }
  for (std::size_t k = 0; k < squares.size(); ++k) squares[k] = std::sqrt(squares[k] / free[k]);
  return squares;
}

TEST_F(FoundEffectsTest, LeavesOutWhatIsUnknownAndNamesIt) {
  Findings all;
  all.devices = {{.device = "laser1",
                  .skew = kNotTested,
                  .delay_median = kNotTested,
                  .delay_95 = kNotTested,
                  .period = kNotTested,
                  .wander = kNotTested}};
  all.noise = {{.laser = "laser1", .sigma = kNotTested}};
  all.findings = {finding("mirror.cone", "laser2", {{.name = "kappa", .unit = "rad", .value = kNotTested}})};
  const FoundEffects found = effects(all);
  EXPECT_TRUE(found.effects.empty());
  EXPECT_THAT(found.others,
              ElementsAre(HasSubstr("clock.drift of laser1, which the file does not hold"),
                          HasSubstr("latency.jitter of laser1"), HasSubstr("noise.normal of laser1"),
                          HasSubstr("mirror.cone of laser2")));
}

TEST_F(FoundEffectsTest, GiveRangesTheNoiseOfTheEstimatedModel) {
  const auto spreads = spreads_at_rest(settings_with(some()).scanner);
  const double step = 1e-3 / std::sqrt(12);
  // 54 100 ranges: the spread of normal ones is determined to 0.3 %.
  EXPECT_NEAR(spreads[0], std::hypot(12e-3, step), 0.012 * 12e-3) << "nothing was found of it";
  EXPECT_NEAR(spreads[1], std::hypot(5e-3, 15e-3 / 2, step), 0.012 * 9e-3);
}

TEST_F(FoundEffectsTest, AreInPlaceOfWhatWouldBeDrawn) {
  RecordingSettings settings = settings_with(some());
  const RecordingTruth truth = draw_devices(settings);
  EXPECT_DOUBLE_EQ(truth.plate.clock.skew, 80e-6);
  EXPECT_DOUBLE_EQ(truth.plate.link.jitter, 1e-4 / std::numbers::ln2);
  EXPECT_NE(truth.lasers[0].clock.skew, 0) << "drawn: nothing is known of it";
  settings.scanner.mirror.wander = 0;
  settings.scanner.beams = {100};
  const auto beams = simulate_measurements(settings.scanner, built_in_scene("office")).beams;
  std::vector<std::vector<double>> fired(3);
  for (std::size_t i = 0; i < beams.size(); ++i) fired[beams.laser[i]].push_back(beams.time[i]);
  EXPECT_GT(std::abs(fired[0][1] - fired[0][0] - 0.02), 1e-6) << "drawn, up to 0.6 % slow";
  EXPECT_NEAR(fired[2][1] - fired[2][0], 0.02 * (1 + 200e-6), 1e-9) << "true seconds, not the laser's";
}

TEST_F(FoundEffectsTest, HaveDelaysBurstsAndWandersAsTheyWereMeasured) {
  Findings findings;
  findings.devices = {{.device = "laser1",
                       .delay_median = 68e-6,
                       .delay_95 = 344e-6,
                       .period = 0.0201,
                       .nominal_period = 0.02,
                       .wander = 1.1e-3}};
  findings.findings = {finding("latency.bursts", "laser2",
                               {{.name = "together", .unit = "1", .value = 0.5},
                                {.name = "interval", .unit = "s", .value = 0.02},
                                {.name = "wait", .unit = "s", .value = 0.1}})};
  const RecordingSettings settings = settings_with(findings);
  EXPECT_DOUBLE_EQ(settings.scanner.laser_effects[0].mirror_wander, 1.1e-3);
  const RecordingTruth truth = draw_devices(settings);
  // Weibull's law F(d) = 1 − exp(−(d / scale)^shape), by hand.
  const LinkSettings& link = truth.lasers[0].link;
  const double scale = link.jitter / std::tgamma(1 + 1 / link.shape);
  EXPECT_NEAR(std::exp(-std::pow(68e-6 / scale, link.shape)), 0.5, 1e-9);
  EXPECT_NEAR(std::exp(-std::pow(344e-6 / scale, link.shape)), 0.05, 1e-9);
  EXPECT_GT(truth.lasers[1].link.stall_rate, 1) << "bursts, many a second";
  EXPECT_EQ(truth.lasers[2].link.stall_rate, LinkSettings{}.stall_rate);
}

TEST_F(FoundEffectsTest, ThatNoSimulatorKnowsAreNamed) {
  Findings findings;
  findings.findings = {finding("scene.moving", "scene", {}), finding("mirror.cone", "laser1", {})};
  findings.findings.push_back({.cause = "range.gremlins", .scope = "laser2", .accepted = false});
  findings.findings.push_back(
      finding("noise.mixed_pixels", "laser3", {{.name = "share_of_edges", .unit = "1", .value = 0.1}}));
  findings.unnamed = {{.covariate = "range", .quantity = "range", .scope = "laser3", .accepted = true}};
  const FoundEffects found = effects(findings);
  EXPECT_THAT(found.others,
              ElementsAre("scene.moving of scene",
                          HasSubstr("noise.mixed_pixels of laser3: the file holds the fraction of edges"),
                          HasSubstr("range of laser3 over the range, unnamed")));
  ASSERT_EQ(found.effects.size(), 1U);
  EXPECT_EQ(found.effects[0].name, "mirror.cone");
  EXPECT_EQ(found.effects[0].owner, 0U);
}

TEST_F(FoundEffectsTest, ThatAreCurvesAreNamed) {
  Findings findings;
  findings.findings = {
      finding("clock.drift", "laser1",
              {{.name = "at0", .unit = "s", .value = 1e-3}, {.name = "span", .unit = "s", .value = 10}}),
      finding("clock.drift", "laser2", {{.name = "rms", .unit = "s", .value = 1e-3}}),
      finding("encoder.eccentricity", "plate", {{.name = "cos3", .unit = "rad", .value = 1e-3}})};
  const FoundEffects found = effects(findings);
  EXPECT_TRUE(found.effects.empty());
  EXPECT_THAT(found.others, ElementsAre(HasSubstr("clock.drift of laser1: a curve"),
                                        HasSubstr("clock.drift of laser2: the file holds the size"),
                                        HasSubstr("encoder.eccentricity of plate: a curve")));
}

TEST_F(FoundEffectsTest, OfDevicesAndValuesThatCannotBeAreRefused) {
  const auto one = [](const std::string& scope, const Parameter& parameter) {
    Findings findings;
    findings.findings = {finding("mirror.cone", scope, {parameter})};
    return findings;
  };
  const auto unknown = complaint(one("laser9", {.name = "kappa", .unit = "rad", .value = 1e-3}));
  for (const char* part : {"diagnosis.json", "findings[0]", "laser9", "laser1, laser2, laser3"}) {
    EXPECT_THAT(unknown, HasSubstr(part));
  }
  EXPECT_THAT(complaint(one("plate", {.name = "kappa", .unit = "rad", .value = 1e-3})),
              HasSubstr("is each laser's, not the plate's"));
  EXPECT_THAT(complaint(one("laser1", {.name = "kapa", .unit = "rad", .value = 1e-3})),
              HasSubstr("mirror.cone has no parameter 'kapa'"));
  EXPECT_THAT(complaint(one("laser1", {.name = "kappa", .unit = "m", .value = 1e-3})), HasSubstr("0.001 m"));
  EXPECT_THAT(complaint(one("laser1", {.name = "kappa", .unit = "rad", .value = 3})),
              HasSubstr("out of range"));
  EXPECT_THAT(complaint(one("laser1", {.name = "kappa", .unit = "rad", .value = HUGE_VAL})),
              HasSubstr("not a number"));
}

}  // namespace
}  // namespace crisp
