// SPDX-License-Identifier: BSD-3-Clause
// Noise components are identified from ranges, and plain noise has none.
#include "plugins/diagnose/noise/noise_diagnosis.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>

#include <crisp/effect_catalogue.hpp>

#include "plugins/diagnose/noise/common_mode_range_error.hpp"
#include "plugins/diagnose/noise/jackknife.hpp"
#include "plugins/diagnose/noise/likelihood_gain.hpp"
#include "plugins/diagnose/noise/noise_components.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::plot;
using testing::IsEmpty;
using testing::SizeIs;

using Random = std::mt19937_64;

constexpr double kSigma = 0.008;

/// Ranges of stationary beams, each at its own distance, less the mean of its beam.
RangeErrors shots(std::uint64_t seed, int beams, int scans,
                  const std::function<double(Random&, int beam, double range)>& error) {
  Random random(seed);
  RangeErrors all;
  for (int beam = 0; beam < beams; ++beam) {
    const double range = 1 + 14.0 * beam / beams;
    std::vector<double> values;
    double mean = 0;
    for (int scan = 0; scan < scans; ++scan) {
      values.push_back(error(random, beam, range));
      mean += values.back() / scans;
    }
    for (int scan = 0; scan < scans; ++scan) {
      all.value.push_back(static_cast<float>(values[static_cast<std::size_t>(scan)] - mean));
      all.range.push_back(static_cast<float>(range));
      all.beam.push_back(static_cast<std::uint16_t>(beam));
      all.block.push_back(static_cast<std::uint32_t>(scan / 5));
    }
  }
  return all;
}

double normal(Random& random) { return std::normal_distribution<>()(random); }

double value_of(const Finding& finding, const std::string& name) {
  return std::ranges::find(finding.parameters, name, &Parameter::name)->value;
}
double error_of(const Finding& finding, const std::string& name) {
  return std::ranges::find(finding.parameters, name, &Parameter::name)->std_error;
}

TEST(NoiseDiagnosis, NamesNoCauseOfPlainNoise) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto found = diagnose_noise(
        "laser1", shots(seed, 200, 100, [](Random& random, int, double) { return kSigma * normal(random); }),
        1);
    EXPECT_THAT(found.findings, IsEmpty()) << seed;
    EXPECT_THAT(found.unnamed, IsEmpty()) << seed;
    EXPECT_NEAR(found.model.sigma(), kSigma, 2e-4);
  }
}

TEST(NoiseDiagnosis, EstimatesTheSeparationOfTwoPeaks) {
  std::vector<double> weights;
  Random draw(7);
  for (int beam = 0; beam < 200; ++beam) weights.push_back(std::uniform_real_distribution<>(0.2, 0.9)(draw));
  const auto found = diagnose_noise("laser1",
                                    shots(2, 200, 150,
                                          [&](Random& random, int beam, double) {
                                            const double weight = weights[static_cast<std::size_t>(beam)];
                                            const bool far =
                                                std::uniform_real_distribution<>(0, 1)(random) < weight;
                                            return 0.005 * normal(random) + (far ? 0.015 : 0);
                                          }),
                                    1);
  ASSERT_THAT(found.findings, SizeIs(1));
  const Finding& finding = found.findings[0];
  EXPECT_EQ(finding.cause, "noise.two_peaks");
  EXPECT_NEAR(value_of(finding, "separation"), 0.015, std::max(3 * error_of(finding, "separation"), 5e-4));
  EXPECT_NEAR(value_of(finding, "least"), 0.2, 3 * error_of(finding, "least"));
  EXPECT_NEAR(value_of(finding, "most"), 0.9, 3 * error_of(finding, "most"));
  EXPECT_LT(error_of(finding, "least"), 0.02);
  EXPECT_GT(finding.gain.at(0).ci95[0], 0);
}

/// Large samples are subsampled; a beam may not be in the subsample.
TEST(NoiseDiagnosis, CoversBeamsOutsideTheSubsample) {
  const auto about_two_values = [](Random& random, int, double) {
    return 0.005 * normal(random) + (std::bernoulli_distribution(0.5)(random) ? 0.015 : 0);
  };
  RangeErrors all = shots(3, 650, 200, about_two_values);
  const RangeErrors part = thinned(all, 120'000);
  std::uint32_t block = 0;  // not in the subsample
  while (std::ranges::count(part.block, block) > 0) ++block;
  all.append(all, static_cast<std::size_t>(std::ranges::find(all.block, block) - all.block.begin()));
  all.beam.back() = 700;
  const NoiseDiagnosis found = diagnose_noise("laser1", all, 1);
  ASSERT_TRUE(found.model.has_peaks());
  EXPECT_TRUE(std::isfinite(found.model.log_density(0, {.range = 3}, 700)));
  EXPECT_EQ(found.model.weight.size(), 701U);
}

EffectParameter bounds_of(const std::string& effect, const std::string& parameter) {
  TermRegistry terms;
  register_built_in(terms);
  const auto catalogue = effect_catalogue(terms);
  const auto& parameters = std::ranges::find(catalogue, effect, &EffectInfo::name)->parameters;
  return *std::ranges::find(parameters, parameter, &EffectParameter::name);
}

TEST(NoiseDiagnosis, StaysWithinTheBoundsOfTheCatalogue) {
  const RangeErrors errors =
      shots(11, 20, 40, [](Random& random, int, double) { return kSigma * normal(random); });
  const auto components = noise_components(errors, kSigma);
  const auto tails = std::ranges::find(components, "noise.heavy_tail", &NoiseComponent::cause);
  ASSERT_NE(tails, components.end());
  NoiseModel model{.tail_share = 0.002, .tail_scale = 1.5, .has_tail = true};
  JackknifedModel fits{.model = model, .errors = errors, .times = {}, .places = {}};
  model.tail_share = 0.004;
  model.tail_scale = 3;
  for (int part = 0; part < 20; ++part) fits.times.push_back({.share = 0.05, .model = model});
  const auto reported = parameters_of(*tails, fits);  // bias-corrected: 0.002 − 19 × 0.002, below 0
  ASSERT_THAT(reported, SizeIs(2));
  EXPECT_EQ(reported[0].value, bounds_of("noise.heavy_tail", "share").lower);
  EXPECT_EQ(reported[1].value, bounds_of("noise.heavy_tail", "scale").lower);
}

TEST(NoiseDiagnosis, EstimatesTheSlopeOfRangeDependentNoise) {
  const auto found = diagnose_noise("laser1",
                                    shots(3, 200, 100,
                                          [](Random& random, int, double range) {
                                            return std::hypot(kSigma, 8e-4 * range) * normal(random);
                                          }),
                                    1);
  ASSERT_THAT(found.findings, SizeIs(1));
  EXPECT_EQ(found.findings[0].cause, "noise.range_dependent");
  EXPECT_NEAR(value_of(found.findings[0], "slope"), 8e-4, 4 * error_of(found.findings[0], "slope"));
  const auto& others = found.findings[0].alternatives;
  ASSERT_FALSE(others.empty()) << "other components were compared";
  EXPECT_EQ(others.front().scope, "laser1");
  EXPECT_GE(others.front().log10_bayes_factor, found.findings[0].log10_bayes_factor);
  EXPECT_TRUE(std::ranges::is_sorted(others, {}, &OtherCause::log10_bayes_factor));
}

TEST(NoiseDiagnosis, EstimatesTheShareOfAHeavyTail) {
  const auto found = diagnose_noise("laser1",
                                    shots(4, 200, 100,
                                          [](Random& random, int, double) {
                                            const bool tail =
                                                std::uniform_real_distribution<>(0, 1)(random) < 0.03;
                                            return kSigma * (tail ? 6 : 1) * normal(random);
                                          }),
                                    1);
  ASSERT_THAT(found.findings, SizeIs(1));
  EXPECT_EQ(found.findings[0].cause, "noise.heavy_tail");
  EXPECT_NEAR(value_of(found.findings[0], "share"), 0.03, 4 * error_of(found.findings[0], "share"));
  EXPECT_NEAR(value_of(found.findings[0], "scale"), 6, 4 * error_of(found.findings[0], "scale"));
}

/// Mean squared error of parameters in units of their standard errors, over seeds.
std::map<std::string, double> mean_squares_off(
    int seeds, int beams, int scans, const std::map<std::string, double>& truth,
    const std::function<double(Random&, int beam, double range)>& error) {
  std::map<std::string, double> squares;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto own = static_cast<std::uint64_t>(seed);
    const auto found = diagnose_noise("laser1", shots(own, beams, scans, error), own);
    for (const auto& [name, value] : truth) {
      if (found.findings.size() != 1) return {{name, HUGE_VAL}};
      const Finding& finding = found.findings[0];
      squares[name] += std::pow((value_of(finding, name) - value) / error_of(finding, name), 2) / seeds;
    }
  }
  return squares;
}

/// Upper bound for the mean square of n values of Student's t with 19 degrees of freedom (twenty jackknife
/// groups): 19/17 plus three standard deviations, by the fourth moment.
double most_by_chance(int seeds) {
  constexpr double kDegreesOfFreedom = 19;
  constexpr double kMean = kDegreesOfFreedom / (kDegreesOfFreedom - 2);
  const double variance =
      3 * kMean * kMean * (kDegreesOfFreedom - 2) / (kDegreesOfFreedom - 4) - kMean * kMean;
  return kMean + 3 * std::sqrt(variance / seeds);
}

TEST(NoiseDiagnosis, HasHonestErrorsOfALightTail) {
  constexpr int kSeeds = 20;
  const auto error = [](Random& random, int, double) {
    const bool tail = std::uniform_real_distribution<>(0, 1)(random) < 0.04;
    return kSigma * (tail ? 4 : 1) * normal(random);
  };
  for (const auto& [name, square] :
       mean_squares_off(kSeeds, 100, 100, {{"share", 0.04}, {"scale", 4}}, error)) {
    EXPECT_LT(square, most_by_chance(kSeeds)) << name;
  }
}

TEST(NoiseDiagnosis, HasHonestErrorsOfTwoPeaksInManyBeams) {
  // The weights of 300 beams come from 100 ranges each. Their errors bias the separation, all in one
  // direction.
  constexpr int kSeeds = 6;
  const auto error = [](Random& random, int beam, double) {
    const double weight = 0.2 + 0.7 * beam / 300;
    const bool far = std::uniform_real_distribution<>(0, 1)(random) < weight;
    return 0.005 * normal(random) + (far ? 0.015 : 0);
  };
  EXPECT_LT(mean_squares_off(kSeeds, 300, 100, {{"separation", 0.015}}, error).at("separation"),
            most_by_chance(kSeeds));
}

TEST(NoiseDiagnosis, NamesNoCauseOfNoiseThatDiffersBetweenBeams) {
  const auto found = diagnose_noise("laser1",
                                    shots(6, 200, 100,
                                          [](Random& random, int beam, double) {
                                            return kSigma * (beam % 3 == 0 ? 2 : 1) * normal(random);
                                          }),
                                    1);
  EXPECT_THAT(found.findings, IsEmpty());
  ASSERT_THAT(found.unnamed, SizeIs(1));
  EXPECT_EQ(found.unnamed[0].covariate, "beam");
  EXPECT_TRUE(found.unnamed[0].accepted);
}

TEST(NoiseDiagnosis, FindsBothOfTwoComponents) {
  const auto found = diagnose_noise(
      "laser1",
      shots(5, 200, 150,
            [](Random& random, int beam, double range) {
              const bool far = std::uniform_real_distribution<>(0, 1)(random) < 0.3 + 0.4 * (beam % 2);
              return std::hypot(0.004, 4e-4 * range) * normal(random) + (far ? 0.02 : 0);
            }),
      1);
  std::vector<std::string> causes;
  for (const auto& finding : found.findings) causes.push_back(finding.cause);
  EXPECT_THAT(causes, testing::UnorderedElementsAre("noise.two_peaks", "noise.range_dependent"));
  for (const auto& finding : found.findings) EXPECT_GT(finding.log10_bayes_factor, 2) << finding.cause;
}

TEST(NoiseDiagnosis, SharesTheGainBetweenFindings) {
  const auto gain = [](double rise) {
    return std::vector<Gain>{{.metric = "log-likelihood a measurement", .unit = "nat", .after = rise}};
  };
  std::vector<Finding> findings = {{.cause = "noise.two_peaks", .gain = gain(0.3)},
                                   {.cause = "noise.heavy_tail", .gain = gain(0.1)},
                                   {.cause = "noise.quantisation", .gain = gain(-0.1)},
                                   {.cause = "range.step", .explained_fraction = 0.7},
                                   {.cause = "noise.mixed_pixels", .explained_fraction = kNotTested}};
  const std::vector<UnnamedFinding> unnamed = {{.covariate = "beam", .gain = gain(0.1)}};
  share_explained(findings, unnamed);
  EXPECT_NEAR(findings[0].explained_fraction, 0.6, 1e-12);
  EXPECT_NEAR(findings[1].explained_fraction, 0.2, 1e-12);
  EXPECT_EQ(findings[2].explained_fraction, 0) << "it has no gain";
  EXPECT_EQ(findings[3].explained_fraction, 0.7) << "judged by another metric";
  EXPECT_TRUE(std::isnan(findings[4].explained_fraction)) << "without a gain";
}

TEST(NoiseDiagnosis, SelectsAStepOrAWarmUpByBic) {
  constexpr int kScans = 200;
  std::vector<double> seconds;
  for (int scan = 0; scan < kScans; ++scan) seconds.push_back(0.02 * scan);
  const auto drawn = [&](const std::function<double(int scan)>& together) {
    Random random(7);
    RangeErrors errors;
    for (int scan = 0; scan < kScans; ++scan) {
      for (int beam = 0; beam < 50; ++beam) {
        errors.value.push_back(static_cast<float>(kSigma * normal(random) + together(scan)));
        errors.range.push_back(3);
        errors.beam.push_back(static_cast<std::uint16_t>(beam));
        errors.block.push_back(static_cast<std::uint32_t>(scan));
      }
    }
    return errors;
  };
  const auto jumping = drawn([](int scan) { return scan < 90 ? 0 : 0.003; });
  const CommonModeError step = common_mode_error(jumping, seconds, 1, 1);
  ASSERT_TRUE(step.change && step.change->is_step);
  EXPECT_FALSE(step.wander);
  auto in_bursts = seconds;
  for (std::size_t scan = 1; scan < in_bursts.size(); ++scan) {
    if (scan % 4 != 0) in_bursts[scan] = in_bursts[scan - 1];
  }
  EXPECT_GE(common_mode_error(drawn([](int scan) { return scan < 91 ? 0 : 0.003; }), in_bursts, 1, 1)
                .change.value()
                .shape_error,
            0.019)
      << "scans 90 and 91 have the same receipt time";
  // Means of 50 beams have σ = 1.1 mm; a straight line leaves 0.75 mm of the step: 200/2 lg 1.44 = 16.
  EXPECT_GT(step.change->log10_bayes_factor, 5);
  const Plot plot = common_plot("laser1", step, jumping, seconds);
  double misfit = 0;
  for (std::size_t scan = 0; scan < seconds.size(); ++scan) {
    misfit += std::pow(plot.series.at(0).y[scan] - 1.65 - plot.series.at(1).y[scan], 2) / kScans;
  }
  EXPECT_LT(std::sqrt(misfit), 1.4) << "[mm] noise of the means: the curve fits them";
  const auto creeping =
      common_mode_error(drawn([](int scan) { return 0.008 * (1 - std::exp(-scan / 60.0)); }), seconds, 1, 1);
  ASSERT_TRUE(creeping.change && !creeping.change->is_step);
  EXPECT_GT(creeping.change->log10_bayes_factor, 2);
  EXPECT_FALSE(creeping.wander);
  const auto quick =
      common_mode_error(drawn([](int scan) { return 0.02 * (1 - std::exp(-scan / 20.0)); }), seconds, 1, 1);
  ASSERT_TRUE(quick.change && !quick.change->is_step);
  EXPECT_GE(quick.change->shape, bounds_of("range.warmup", "T").lower) << "a tenth of the recording is 0.4 s";

  const auto slow = [](int scan) { return 0.003 * std::sin(2 * M_PI * scan / 130.0); };
  const CommonModeError wander = common_mode_error(drawn(slow), seconds, 1, 1);
  EXPECT_FALSE(wander.change) << "a wander has no named cause";
  ASSERT_TRUE(wander.wander);
  EXPECT_NEAR(wander.wander->rms, 0.0021, 4 * 0.0011 / std::sqrt(200));
  EXPECT_LT(wander.wander->p_value, 1e-6);
  EXPECT_TRUE(wander.wander->gain.significant_decrease());
  const CommonModeError both =
      common_mode_error(drawn([&](int scan) { return slow(scan) + (scan < 90 ? 0 : 0.009); }), seconds, 1, 1);
  EXPECT_TRUE(both.wander);
  ASSERT_TRUE(both.change && both.change->is_step);
  EXPECT_NEAR(both.change->shape, seconds[90], 0.021);
  EXPECT_NEAR(both.change->size, 0.009, 4 * both.change->std_error);
  const CommonModeError still = common_mode_error(drawn([](int) { return 0; }), seconds, 1, 1);
  EXPECT_FALSE(still.change || still.wander);
  EXPECT_EQ(still.curve.size(), 0);

  RangeErrors exact = jumping;
  std::ranges::fill(exact.value, 0.0F);
  const CommonModeError nothing = common_mode_error(exact, seconds, 1, 1);
  EXPECT_FALSE(nothing.change || nothing.wander);
  const CommonModeError at_once = common_mode_error(jumping, std::vector<double>(kScans, 1.0), 1, 1);
  EXPECT_FALSE(at_once.change || at_once.wander) << "constant receipt times";
}

}  // namespace
}  // namespace crisp
