// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/surface_range_errors.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "pipeline/statistics/quantile_groups.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/noise/likelihood_gain.hpp"
#include "plugins/diagnose/noise/noise_components.hpp"

namespace crisp::diagnose {
namespace {

/// Whether two consecutive shots of a laser are of neighbouring beams: adjacent in a scan, or of a
/// single-beam laser on a turning head.
bool follow_each_other(const Measurements& beams, std::size_t first, std::size_t second) {
  const int step = int{beams.beam[second]} - int{beams.beam[first]};
  return step == 1 || step == 0;
}

constexpr std::size_t kGroups = 10;

/// Noise of each group relative to the noise model.
struct GroupScales {
  std::array<double, kGroups> count{};
  std::array<double, kGroups> scale{};
  double p_value = 1;
};

GroupScales scales_of(const std::vector<std::uint32_t>& groups, const std::vector<double>& squares,
                      const std::vector<bool>& is_used) {
  GroupScales result;
  std::array<double, kGroups> sum{};
  double fourth = 0;
  double all = 0;
  double used = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (!is_used[i]) continue;
    result.count[groups[i]] += 1;
    sum[groups[i]] += squares[i];
    all += squares[i];
    fourth += squares[i] * squares[i];
    used += 1;
  }
  const double mean = all / std::max(1.0, used);
  const double variance = fourth / std::max(1.0, used) - mean * mean;
  double chi2 = 0;
  double degrees_of_freedom = -1;
  for (std::size_t g = 0; g < kGroups; ++g) {
    result.scale[g] = 1;
    if (result.count[g] == 0) continue;
    result.scale[g] = std::sqrt(sum[g] / result.count[g] / mean);
    chi2 += result.count[g] * std::pow(sum[g] / result.count[g] - mean, 2) / variance;
    degrees_of_freedom += 1;
  }
  if (degrees_of_freedom > 0)
    result.p_value = cdf(complement(boost::math::chi_squared(degrees_of_freedom), chi2));
  return result;
}

}  // namespace

RangeErrors scatter_of(std::size_t laser, const Measurements& beams, const BeamAssociation& association,
                       double usual, const std::vector<std::uint32_t>& block) {
  constexpr double kOn = 4;  // standard deviations
  constexpr double kFarOff = 5;
  constexpr double kFarthest = 25;
  const auto is_on = [&](std::size_t i, std::uint32_t surface) {
    return association.ahead[i] == surface && std::abs(double{association.error[i]}) < kOn * usual;
  };
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams.laser[i] == laser) own.push_back(i);
  }
  RangeErrors scatter;
  const auto add = [&](std::size_t i, float error) {
    scatter.value.push_back(error);
    scatter.range.push_back(beams.range[i] - association.error[i]);
    scatter.beam.push_back(beams.beam[i]);
    scatter.block.push_back(block[i]);
    scatter.place.push_back(association.place[i]);
    scatter.cosine.push_back(association.cosine[i]);
    scatter.remission.push_back(beams.remission[i]);
  };
  for (std::size_t k = 1; k + 1 < own.size(); ++k) {
    const std::size_t i = own[k];
    if (association.ahead[i] == kNoSurface) continue;
    if (!follow_each_other(beams, own[k - 1], i) || !follow_each_other(beams, i, own[k + 1])) continue;
    if (!is_on(own[k - 1], association.ahead[i]) || !is_on(own[k + 1], association.ahead[i])) continue;
    const double error = double{association.error[i]} / usual;
    if (error < -kFarOff || error > kFarthest) continue;
    add(i, association.error[i]);
    if (error > kFarOff) add(i, -association.error[i]);
  }
  scatter.centre_beams();
  return scatter;
}

double widest_deviation(const NoiseModel& model, const RangeErrors& errors) {
  constexpr double kMax = 0.99;
  std::vector<double> deviations;
  deviations.reserve(errors.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    deviations.push_back(model.deviation(errors.echo(i), errors.beam[i]));
  }
  return statistics::quantile_in_place(deviations, kMax);
}

std::optional<UnnamedFinding> noise_by(const std::string& name, std::span<const float> values,
                                       const std::string& scope, const RangeErrors& errors,
                                       const NoiseModel& model, double least_gain, std::uint64_t seed) {
  constexpr double kUnlikely = 0.002;
  if (errors.size() < 100 * kGroups || !are_various(values)) return std::nullopt;
  const auto groups = statistics::groups_of(values, kGroups);
  std::vector<double> squares;
  std::vector<bool> is_even;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double sigma = model.deviation(errors.echo(i), errors.beam[i]);
    squares.push_back(std::pow(double{errors.value[i]} / sigma, 2));
    is_even.push_back(errors.block[i] % 2 == 0);
  }
  const GroupScales all = scales_of(groups, squares, std::vector<bool>(groups.size(), true));
  if (!(all.p_value < kUnlikely)) return std::nullopt;
  const GroupScales half = scales_of(groups, squares, is_even);
  std::vector<double> before;
  std::vector<double> after;
  std::vector<std::uint32_t> blocks;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (is_even[i]) continue;
    const double scale = half.scale[groups[i]];
    const double value{errors.value[i]};
    before.push_back(model.log_density(value, errors.echo(i), errors.beam[i]));
    after.push_back(model.log_density(value / scale, errors.echo(i), errors.beam[i]) - std::log(scale));
    blocks.push_back(errors.block[i]);
  }
  const Gain gain = likelihood_gain(before, after, blocks, seed);
  if (gain.after - gain.before < least_gain) return std::nullopt;
  double change = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    change += std::pow(model.deviation(errors.echo(i), errors.beam[i]) * (all.scale[groups[i]] - 1), 2);
  }
  return UnnamedFinding{.covariate = name,
                        .quantity = "noise",
                        .scope = scope,
                        .amplitude = std::sqrt(change / static_cast<double>(errors.size())),
                        .unit = "m",
                        .p_value = all.p_value,
                        .gain = {gain},
                        .accepted = gain.significant_increase()};
}

}  // namespace crisp::diagnose
