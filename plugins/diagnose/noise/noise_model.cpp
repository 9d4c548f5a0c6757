// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/noise_model.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "pipeline/statistics/random_stream.hpp"
#include "plugins/diagnose/noise/expectation_step.hpp"

namespace crisp::diagnose {
namespace {

using model::EchoConditions;

/// One of up to four components of the normal mixture.
struct Part {
  double share = 1;
  double mean = 0;
  double scale = 1;  // relative standard deviation
};

struct Parts {
  std::array<Part, 4> all;
  std::size_t count = 0;
};

Parts parts_of(const NoiseModel& model, std::uint16_t beam) {
  Parts parts;
  const double weight = model.has_peaks() ? model.weight[beam] : 0;
  const double tail = model.has_tail ? model.tail_share : 0;
  for (const bool far : {false, true}) {
    if (far && !model.has_peaks()) break;
    const double mean = model.separation * ((far ? 1 : 0) - weight);
    const double share = far ? weight : 1 - weight;
    parts.all[parts.count++] = {.share = share * (1 - tail), .mean = mean};
    if (!model.has_tail) continue;
    parts.all[parts.count++] = {.share = share * tail, .mean = mean, .scale = model.tail_scale};
  }
  return parts;
}

double density(const Part& part, double value, double sigma) {
  const double s = part.scale * sigma;
  const double z = (value - part.mean) / s;
  return part.share * std::exp(-z * z / 2) / (s * std::sqrt(2 * std::numbers::pi));
}

/// Quantile of the standard normal distribution at an upper-tail probability.
double score_above(double share) {
  using Quick = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return std::numbers::sqrt2 * boost::math::erfc_inv(2 * std::max(share, 1e-300), Quick());
}

double relative_of(const NoiseModel& model, std::uint16_t beam) {
  return model.has_relative() ? model.relative[beam] : 1;
}

constexpr double kMinVariance = 1e-10;  // [m²]

/// The maximum-likelihood normal distribution about 0.
NoiseModel fitted_normal(NoiseModel model, const RangeErrors& errors) {
  double squares = 0;
  for (const float value : errors.value) squares += double{value} * double{value};
  const double variance = squares / std::max(1.0, static_cast<double>(errors.size()));
  model.size = {std::sqrt(std::max(kMinVariance, variance)), 0, 0, 0};
  return model;
}

void take_variance(const ExpectationSums& sums, NoiseModel& model) {
  const std::vector<double> squares = sums.variance.solution();
  for (std::size_t part = 0; part < model::kVarianceParts; ++part)
    model.size[part] = std::sqrt(squares[part]);
  model.size[0] = std::sqrt(std::max(kMinVariance, squares[0]));
}

/// Sets the relative deviations of beams, normalized to a mean of about 1.
void take_relative(const ExpectationSums& sums, NoiseModel& model) {
  double logarithms = 0;
  double beams = 0;
  for (std::size_t b = 0; b < model.relative.size(); ++b) {
    model.relative[b] = std::sqrt((sums.squares[b] + 1) / (sums.of_beam[b] + 1));
    if (sums.of_beam[b] == 0) continue;
    logarithms += std::log(model.relative[b]);
    beams += 1;
  }
  const double usual = std::exp(logarithms / std::max(1.0, beams));
  for (double& relative : model.relative) relative /= usual;
  for (double& size : model.size) size *= usual;
}

void take(const ExpectationSums& sums, NoiseModel& model) {
  constexpr double kMinScale = 1.5;
  take_variance(sums, model);
  if (model.has_relative()) take_relative(sums, model);
  if (model.has_tail) {
    model.tail_share = std::clamp(sums.tail / sums.ranges, 1e-6, 0.5);
    if (sums.tail > 0) model.tail_scale = std::max(kMinScale, std::sqrt(sums.tail_squares / sums.tail));
  }
  if (model.has_peaks()) {
    if (sums.separation_weight > 0)
      model.separation = std::max(0.0, sums.separation / sums.separation_weight);
    for (std::size_t b = 0; b < model.weight.size(); ++b) {
      model.weight[b] = (sums.far[b] + 0.5) / (sums.of_beam[b] + 1);
    }
  }
}

}  // namespace

void RangeErrors::append(const RangeErrors& from, std::size_t i) {
  value.push_back(from.value[i]);
  range.push_back(from.range[i]);
  if (!from.cosine.empty()) cosine.push_back(from.cosine[i]);
  if (!from.remission.empty()) remission.push_back(from.remission[i]);
  beam.push_back(from.beam[i]);
  block.push_back(from.block[i]);
  if (!from.place.empty()) place.push_back(from.place[i]);
}

void RangeErrors::centre_beams() {
  std::vector<double> sums(beams_of(*this), 0);
  std::vector<double> counts(sums.size(), 0);
  for (std::size_t i = 0; i < size(); ++i) {
    sums[beam[i]] += double{value[i]};
    counts[beam[i]] += 1;
  }
  for (std::size_t i = 0; i < size(); ++i) value[i] -= static_cast<float>(sums[beam[i]] / counts[beam[i]]);
}

EchoConditions RangeErrors::echo(std::size_t i) const {
  EchoConditions echo{.range = double{range[i]}};
  if (!cosine.empty()) echo.cosine = double{cosine[i]};
  if (!remission.empty()) echo.remission = double{remission[i]};
  return echo;
}

RangeErrors select(const RangeErrors& errors, const std::function<bool(std::size_t)>& keep) {
  RangeErrors some;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (keep(i)) some.append(errors, i);
  }
  return some;
}

RangeErrors thinned(const RangeErrors& errors, std::size_t most) {
  constexpr std::uint32_t kMixed = 2'654'435'761;  // Knuth's multiplicative hash
  const auto nth = static_cast<std::uint32_t>((errors.size() + most - 1) / most);
  if (nth <= 1) return errors;
  return select(errors, [&](std::size_t i) { return (errors.block[i] * kMixed >> 16) % nth == 0; });
}

std::size_t beams_of(const RangeErrors& errors) {
  return errors.beam.empty() ? 0 : std::ranges::max(errors.beam) + std::size_t{1};
}

bool NoiseModel::is_normal() const {
  return std::ranges::count(parts, true) == 1 && !has_tail && !has_peaks() && !has_relative();
}

double NoiseModel::deviation(const EchoConditions& echo, std::uint16_t beam) const {
  return relative_of(*this, beam) * model::deviation(size, echo);
}

double NoiseModel::variance(const EchoConditions& echo, std::uint16_t beam) const {
  const double tail = has_tail ? tail_share * (tail_scale * tail_scale - 1) : 0;
  const double far = has_peaks() ? weight[beam] : 0;
  return std::pow(deviation(echo, beam), 2) * (1 + tail) + separation * separation * far * (1 - far);
}

double NoiseModel::log_density(double value, const EchoConditions& echo, std::uint16_t beam) const {
  const Parts all = parts_of(*this, beam);
  const double sigma_here = deviation(echo, beam);
  double sum = 1e-300;
  for (std::size_t k = 0; k < all.count; ++k) sum += density(all.all[k], value, sigma_here);
  return std::log(sum);
}

double NoiseModel::normal_score(double value, const EchoConditions& echo, std::uint16_t beam) const {
  const Parts all = parts_of(*this, beam);
  const double sigma_here = deviation(echo, beam);
  double below = 0;
  double above = 0;
  for (std::size_t k = 0; k < all.count; ++k) {
    const Part& part = all.all[k];
    const double score = (value - part.mean) / (part.scale * sigma_here);
    if (all.count == 1) return score;
    below += part.share / 2 * std::erfc(-score / std::numbers::sqrt2);
    above += part.share / 2 * std::erfc(score / std::numbers::sqrt2);
  }
  return below < above ? -score_above(below) : score_above(above);
}

double NoiseModel::drawn(statistics::RandomStream& random, const EchoConditions& echo,
                         std::uint16_t beam) const {
  const Parts all = parts_of(*this, beam);
  double left = random.uniform();
  std::size_t k = 0;
  while (k + 1 < all.count && left >= all.all[k].share) left -= all.all[k++].share;
  const Part& part = all.all[k];
  return part.mean + part.scale * deviation(echo, beam) * random.normal();
}

NoiseModel fitted(const NoiseModel& like, const RangeErrors& errors, double settled) {
  constexpr int kMaxRounds = 300;
  if (like.is_normal()) return fitted_normal(like, errors);
  // The ranges may lack the last beams that the model was fitted to.
  const std::size_t beams = std::max({beams_of(errors), like.weight.size(), like.relative.size()});
  const ExpectationStep step(errors);
  NoiseModel model = like;
  double last = -HUGE_VAL;
  for (int round = 0; round < kMaxRounds; ++round) {
    const ExpectationSums sums = step.sums(model, beams);
    take(sums, model);
    if (sums.log_likelihood - last < settled) break;
    last = sums.log_likelihood;
  }
  return model;
}

}  // namespace crisp::diagnose
