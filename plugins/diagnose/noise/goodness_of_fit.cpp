// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/goodness_of_fit.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/statistics/multiple_testing.hpp"
#include "pipeline/statistics/quantile_groups.hpp"
#include "pipeline/statistics/random_stream.hpp"
#include "plugins/diagnose/noise/common_mode_range_error.hpp"
#include "plugins/diagnose/noise/noise_components.hpp"

namespace crisp::diagnose {
namespace {

using Scores = std::vector<double>;

/// A test statistic of the normal scores, approximately χ²-distributed under the noise model.
struct SingleTest {
  std::string covariate, quantity, unit;
  double scale = 1;  // the squared amplitude is scale² times the statistic's excess over its expectation
  std::function<double(const Scores&)> statistic;
};

/// Pearson's χ² statistic over bins of a quarter of a standard deviation.
double density_statistic(const Scores& scores) {
  constexpr double kWidth = 0.25;
  constexpr std::size_t kInner = 26;
  constexpr double kFirst = -kWidth * kInner / 2;
  std::array<double, kInner + 2> counts{};
  for (const double score : scores) {
    const double bin = std::clamp(std::floor((score - kFirst) / kWidth), -1.0, double{kInner});
    counts[static_cast<std::size_t>(bin + 1)] += 1;
  }
  const auto below = [&](std::size_t bin) {  // cumulative probability at the bin's upper end
    const double end = kFirst + kWidth * static_cast<double>(bin);
    return bin > kInner ? 1.0 : std::erfc(-end / std::numbers::sqrt2) / 2;
  };
  const auto all = static_cast<double>(scores.size());
  double chi2 = 0;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    const double expected = all * (below(bin) - (bin > 0 ? below(bin - 1) : 0));
    chi2 += std::pow(counts[bin] - expected, 2) / expected;
  }
  return chi2;
}

struct Group {
  double count = 0, sum = 0, squares = 0;
};

std::vector<Group> sums_in(const std::vector<std::uint32_t>& groups, const Scores& scores) {
  std::vector<Group> sums(std::ranges::max(groups) + std::size_t{1});
  for (std::size_t i = 0; i < scores.size(); ++i) {
    Group& sum = sums[groups[i]];
    sum.count += 1;
    sum.sum += scores[i];
    sum.squares += scores[i] * scores[i];
  }
  std::erase_if(sums, [](const Group& sum) { return sum.count == 0; });
  return sums;
}

/// χ² statistic of the groups' mean squares, normalized by the cube root (Wilson and Hilferty 1931).
double spread_statistic(const std::vector<std::uint32_t>& groups, const Scores& scores) {
  double chi2 = 0;
  for (const Group& group : sums_in(groups, scores)) {
    const double variance = 2 / (9 * group.count);
    chi2 += std::pow(std::cbrt(group.squares / group.count) - 1 + variance, 2) / variance;
  }
  return chi2;
}

double mean_statistic(const std::vector<std::uint32_t>& groups, const Scores& scores) {
  double chi2 = 0;
  for (const Group& group : sums_in(groups, scores)) chi2 += group.sum * group.sum / group.count;
  return chi2;
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// @param expected  correlation under the noise model
double correlation_statistic(const Pairs& pairs, double expected, const Scores& scores) {
  double squares = 0;
  for (const double score : scores) squares += score * score;
  double products = 0;
  for (const auto& [first, second] : pairs) products += scores[first] * scores[second];
  const auto count = static_cast<double>(pairs.size());
  return count * std::pow(products / count / (squares / static_cast<double>(scores.size())) - expected, 2);
}

/// Pairs of ranges that are adjacent in one index and equal in the other.
template <class Same, class Along>
Pairs neighbours(const std::vector<Same>& same, const std::vector<Along>& along) {
  std::vector<std::uint32_t> order(same.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::tuple(same[i], along[i]); });
  Pairs pairs;
  for (std::size_t k = 1; k < order.size(); ++k) {
    const std::uint32_t first = order[k - 1];
    const std::uint32_t second = order[k];
    if (same[first] == same[second] && along[first] + 1U == along[second]) pairs.emplace_back(first, second);
  }
  return pairs;
}

class ScoreStatistics {
 public:
  ScoreStatistics(const RangeErrors& errors, BeamsOf beams) : ranges_(static_cast<double>(errors.size())) {
    double squares = 0;
    for (const float value : errors.value) squares += std::pow(double{value}, 2);
    sigma_ = std::sqrt(squares / ranges_);
    all_.push_back({"error", "density", "1", 1 / std::sqrt(ranges_), density_statistic});
    const std::vector<std::uint32_t> beam(errors.beam.begin(), errors.beam.end());
    add_spread("beam", beam);
    add_spread_by("range", errors.range);
    add_spread_by("incidence", errors.cosine);
    add_spread_by("remission", errors.remission);
    if (beams == BeamsOf::kSurfaces) return;
    add_spread("time", errors.block);
    add_mean("time", errors.block);
    if (are_various(errors.remission))
      add_mean("remission", statistics::groups_of(errors.remission, kGroups));
    // Centring the values of a beam makes them negatively correlated.
    const double off_the_mean = -static_cast<double>(sums_in(beam, Scores(beam.size())).size()) / ranges_;
    add_correlation("next scan", neighbours(errors.beam, errors.block), off_the_mean);
    add_correlation("next beam", neighbours(errors.block, errors.beam), 0);
  }

  const std::vector<SingleTest>& all() const { return all_; }
  std::vector<double> statistics(const Scores& scores) const {
    std::vector<double> values;
    for (const SingleTest& test : all_) values.push_back(test.statistic(scores));
    return values;
  }

 private:
  static constexpr std::size_t kGroups = 12;

  void add_spread(const std::string& covariate, const std::vector<std::uint32_t>& groups) {
    if (std::ranges::max(groups) == std::ranges::min(groups))
      return;  // single-beam laser: nothing to compare
    all_.push_back({covariate, "noise", "m", sigma_ / std::sqrt(2 * ranges_),
                    [groups](const Scores& scores) { return spread_statistic(groups, scores); }});
  }
  void add_spread_by(const std::string& covariate, std::span<const float> values) {
    if (are_various(values)) add_spread(covariate, statistics::groups_of(values, kGroups));
  }
  void add_mean(const std::string& covariate, const std::vector<std::uint32_t>& groups) {
    all_.push_back({covariate, "range", "m", sigma_ / std::sqrt(ranges_),
                    [groups](const Scores& scores) { return mean_statistic(groups, scores); }});
  }
  void add_correlation(const std::string& covariate, const Pairs& pairs, double expected) {
    if (pairs.empty()) return;
    all_.push_back(
        {covariate, "correlation", "1", 1 / std::sqrt(static_cast<double>(pairs.size())),
         [pairs, expected](const Scores& scores) { return correlation_statistic(pairs, expected, scores); }});
  }

  double ranges_;
  double sigma_ = 0;
  std::vector<SingleTest> all_;
};

/// [m] Quantization step of the ranges, a multiple of 0.1 mm; 0 without quantization.
double step_of(const RangeErrors& errors) {
  constexpr double kUnit = 1e-4;  // [m]
  constexpr double kOff = 0.2;    // units: rounding of single precision
  std::int64_t step = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double units = (double{errors.range[i]} + double{errors.value[i]}) / kUnit;
    if (std::abs(units - std::round(units)) > kOff) return 0;
    step = std::gcd(step, std::llround(units));
  }
  return kUnit * static_cast<double>(step);
}

/// The noise model fitted to measured ranges, with the further properties of the simulation.
struct Simulator {
  NoiseModel model;
  Eigen::VectorXd curve;
  double step = 0;
};

/// Simulates ranges in place of the measured ones, with the device's quantization.
RangeErrors made_by(const Simulator& by, RangeErrors errors, std::uint64_t seed) {
  statistics::RandomStream random(seed, "ranges");
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double at = double{errors.range[i]} + (by.curve.size() > 0 ? by.curve[errors.block[i]] : 0);
    double range = at + by.model.drawn(random, errors.echo(i), errors.beam[i]);
    if (by.step > 0) range = by.step * std::round(range / by.step);
    errors.value[i] = static_cast<float>(range - at);
  }
  errors.centre_beams();
  return errors;
}

Scores scores_of(const NoiseModel& model, const RangeErrors& errors) {
  Scores scores;
  scores.reserve(errors.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    scores.push_back(model.normal_score(double{errors.value[i]}, errors.echo(i), errors.beam[i]));
  }
  return scores;
}

/// Null distribution of one statistic: a scaled χ² whose scale and degrees of freedom match the simulations'
/// moments (Satterthwaite).
class Chance {
 public:
  explicit Chance(const std::vector<double>& simulated) {
    const auto count = static_cast<double>(simulated.size());
    mean_ = std::accumulate(simulated.begin(), simulated.end(), 0.0) / count;
    double squares = 0;
    for (const double value : simulated) squares += std::pow(value - mean_, 2);
    variance_ = squares / (count - 1);
  }
  double mean() const { return mean_; }
  double of(double value) const {
    constexpr double kMaxDegreesOfFreedom = 1e5;  // more than any number of groups: the statistic is constant
    if (!(kMaxDegreesOfFreedom * variance_ > 2 * mean_ * mean_)) return 1;
    const boost::math::chi_squared model(2 * mean_ * mean_ / variance_);
    return cdf(complement(model, value * 2 * mean_ / variance_));
  }

 private:
  double mean_ = 0;
  double variance_ = 0;
};

/// Null distributions of all statistics.
struct Chances {
  std::vector<Chance> of_test;
  double independent = 1;  // effective number of independent tests
};

Chances chances_in(const ScoreStatistics& tests, const Simulator& by, const RangeErrors& errors,
                   std::uint64_t seed) {
  constexpr std::size_t kSimulations = 99;
  std::vector<std::vector<double>> simulated(tests.all().size(), std::vector<double>(kSimulations));
  quality::for_each_index(kSimulations, [&](std::size_t s) {
    const RangeErrors made = made_by(by, errors, seed + s);
    const auto values = tests.statistics(scores_of(fitted(by.model, made), made));
    for (std::size_t k = 0; k < values.size(); ++k) simulated[k][s] = values[k];
  });
  Chances chances;
  std::vector<double> least(kSimulations, 1.0);
  for (const auto& values : simulated) {
    const Chance& chance = chances.of_test.emplace_back(values);
    for (std::size_t s = 0; s < kSimulations; ++s) least[s] = std::min(least[s], chance.of(values[s]));
  }
  chances.independent = statistics::effective_number_of_tests(least);
  return chances;
}

}  // namespace

data::FitStatistics goodness_of_noise_model(const RangeErrors& all, const NoiseModel& like,
                                            const Eigen::VectorXd& curve, BeamsOf beams, std::uint64_t seed) {
  constexpr std::size_t kMax = 60'000;
  RangeErrors errors = thinned(all, kMax);
  const double step = step_of(errors);
  if (curve.size() > 0) {
    subtract_curve(curve, errors);
  } else {
    errors.centre_beams();  // of the reduced sample, as in the simulations
  }
  const NoiseModel model = fitted(like, errors);
  const ScoreStatistics tests(errors, beams);
  const Chances chances = chances_in(tests, {.model = model, .curve = curve, .step = step}, errors, seed);
  const auto measured = tests.statistics(scores_of(model, errors));
  data::FitStatistics result;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const SingleTest& test = tests.all()[k];
    const Chance& chance = chances.of_test[k];
    result.tests.push_back(
        {.covariate = test.covariate,
         .quantity = test.quantity,
         .unit = test.unit,
         .amplitude = test.scale * std::sqrt(std::max(0.0, measured[k] - chance.mean())),
         .p_value = statistics::sidak_p_value(chances.independent, chance.of(measured[k]))});
    result.p_value = std::min(result.p_value, result.tests.back().p_value);
  }
  return result;
}

data::GoodnessOfFit goodness_of_fit(const std::string& laser, const RangeErrors& errors,
                                    const NoiseModel& named, const Eigen::VectorXd& curve, BeamsOf beams,
                                    std::uint64_t seed) {
  NoiseModel model = named;
  model.relative.clear();
  data::GoodnessOfFit result{
      .scope = laser, .before = goodness_of_noise_model(errors, {}, {}, beams, seed), .after = {}};
  const bool is_plain = model.is_normal() && curve.size() == 0;
  result.after = is_plain ? result.before : goodness_of_noise_model(errors, model, curve, beams, seed);
  return result;
}

}  // namespace crisp::diagnose
