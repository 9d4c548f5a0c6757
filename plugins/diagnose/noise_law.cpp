// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise_law.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "plugins/diagnose/non_negative.hpp"

namespace crisp {
namespace {

/// One of the up to four normal laws that a range may have come from.
struct Part {
  double share = 1;
  double mean = 0;
  double scale = 1;  // of the standard deviation
  bool far = false;
  bool tail = false;
};

struct Parts {
  std::array<Part, 4> all;
  std::size_t count = 0;
};

Parts parts_of(const NoiseLaw& law, std::uint16_t beam) {
  Parts parts;
  const double weight = law.has_peaks() ? law.weight[beam] : 0;
  const double tail = law.has_tail ? law.tail_share : 0;
  for (const bool far : {false, true}) {
    if (far && !law.has_peaks()) break;
    const double mean = law.separation * ((far ? 1 : 0) - weight);
    const double share = far ? weight : 1 - weight;
    parts.all[parts.count++] = {.share = share * (1 - tail), .mean = mean, .far = far};
    if (!law.has_tail) continue;
    parts.all[parts.count++] = {
        .share = share * tail, .mean = mean, .scale = law.tail_scale, .far = far, .tail = true};
  }
  return parts;
}

double density(const Part& part, double value, double sigma) {
  const double s = part.scale * sigma;
  const double z = (value - part.mean) / s;
  return part.share * std::exp(-z * z / 2) / (s * std::sqrt(2 * std::numbers::pi));
}

/// The value above which a standard normal law has so much of 1.
double score_above(double share) {
  using Quick = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return std::numbers::sqrt2 * boost::math::erfc_inv(2 * std::max(share, 1e-300), Quick());
}

double relative_of(const NoiseLaw& law, std::uint16_t beam) {
  return law.has_relative() ? law.relative[beam] : 1;
}

/// Sums of one round of expectation.
struct Sums {
  double all = 0, likelihood = 0, tail = 0, tail_squares = 0;
  double separation = 0, separation_weight = 0;
  NonNegativeProblem variance{kVarianceParts};  // squares, as sums of the parts' unit variances
  std::vector<double> far, of_beam, squares;    // by beam
};

void add(const NoiseLaw& law, double value, const EchoConditions& echo, std::uint16_t beam, Sums& sums) {
  const Parts parts = parts_of(law, beam);
  const double sigma = law.deviation(echo, beam);
  const double relative = relative_of(law, beam);
  std::array<double, 4> probable{};
  double total = 1e-300;
  for (std::size_t k = 0; k < parts.count; ++k) {
    probable[k] = density(parts.all[k], value, sigma);
    total += probable[k];
  }
  sums.all += 1;
  sums.likelihood += std::log(total);
  sums.of_beam[beam] += 1;
  double square = 0;  // of what is normal and of a usual beam, as is to be expected
  double weight = 0;
  for (std::size_t k = 0; k < parts.count; ++k) {
    const Part& part = parts.all[k];
    const double p = probable[k] / total;
    square += p * std::pow((value - part.mean) / (part.scale * relative), 2);
    weight += p;
    if (part.tail) {
      sums.tail += p;
      sums.tail_squares += p * std::pow((value - part.mean) / sigma, 2);
    }
    if (!law.has_peaks()) continue;
    const double lever = (part.far ? 1 : 0) - law.weight[beam];
    const double precision = p / std::pow(part.scale * sigma, 2);
    sums.separation += precision * value * lever;
    sums.separation_weight += precision * lever * lever;
    if (part.far) sums.far[beam] += p;
  }
  if (!(weight > 0)) return;  // so far out that no part can have made it
  const double variance = std::pow(sigma / relative, 2);
  ByPart units = unit_variances(echo);
  for (std::size_t part = 0; part < kVarianceParts; ++part) units[part] *= law.parts[part] ? 1 : 0;
  sums.variance.add(units, square / weight, weight / (variance * variance));
  sums.squares[beam] += square / variance * relative * relative;
}

void take_variance(const Sums& sums, NoiseLaw& law) {
  constexpr double kLeast = 1e-10;  // [m²]
  const std::vector<double> squares = sums.variance.solution();
  for (std::size_t part = 0; part < kVarianceParts; ++part) law.size[part] = std::sqrt(squares[part]);
  law.size[0] = std::sqrt(std::max(kLeast, squares[0]));
}

/// About 1, so that the variance's parts are those of a usual beam.
void take_relative(const Sums& sums, NoiseLaw& law) {
  double logarithms = 0;
  double beams = 0;
  for (std::size_t b = 0; b < law.relative.size(); ++b) {
    law.relative[b] = std::sqrt((sums.squares[b] + 1) / (sums.of_beam[b] + 1));
    if (sums.of_beam[b] == 0) continue;
    logarithms += std::log(law.relative[b]);
    beams += 1;
  }
  const double usual = std::exp(logarithms / std::max(1.0, beams));
  for (double& relative : law.relative) relative /= usual;
  for (double& size : law.size) size *= usual;
}

void take(const Sums& sums, NoiseLaw& law) {
  constexpr double kLeastScale = 1.5;
  take_variance(sums, law);
  if (law.has_relative()) take_relative(sums, law);
  if (law.has_tail) {
    law.tail_share = std::clamp(sums.tail / sums.all, 1e-6, 0.5);
    if (sums.tail > 0) law.tail_scale = std::max(kLeastScale, std::sqrt(sums.tail_squares / sums.tail));
  }
  if (law.has_peaks()) {
    if (sums.separation_weight > 0) law.separation = std::max(0.0, sums.separation / sums.separation_weight);
    for (std::size_t b = 0; b < law.weight.size(); ++b) {
      law.weight[b] = (sums.far[b] + 0.5) / (sums.of_beam[b] + 1);
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
  constexpr std::uint32_t kStrewn = 2'654'435'761;  // Knuth's multiplicative hash
  const auto nth = static_cast<std::uint32_t>((errors.size() + most - 1) / most);
  if (nth <= 1) return errors;
  return select(errors, [&](std::size_t i) { return (errors.block[i] * kStrewn >> 16) % nth == 0; });
}

std::size_t beams_of(const RangeErrors& errors) {
  return errors.beam.empty() ? 0 : std::ranges::max(errors.beam) + std::size_t{1};
}

bool NoiseLaw::is_normal() const {
  return std::ranges::count(parts, true) == 1 && !has_tail && !has_peaks() && !has_relative();
}

double NoiseLaw::deviation(const EchoConditions& echo, std::uint16_t beam) const {
  return relative_of(*this, beam) * crisp::deviation(size, echo);
}

double NoiseLaw::variance(const EchoConditions& echo, std::uint16_t beam) const {
  const double tail = has_tail ? tail_share * (tail_scale * tail_scale - 1) : 0;
  const double far = has_peaks() ? weight[beam] : 0;
  return std::pow(deviation(echo, beam), 2) * (1 + tail) + separation * separation * far * (1 - far);
}

double NoiseLaw::log_density(double value, const EchoConditions& echo, std::uint16_t beam) const {
  const Parts all = parts_of(*this, beam);
  const double sigma_here = deviation(echo, beam);
  double sum = 1e-300;
  for (std::size_t k = 0; k < all.count; ++k) sum += density(all.all[k], value, sigma_here);
  return std::log(sum);
}

double NoiseLaw::normal_score(double value, const EchoConditions& echo, std::uint16_t beam) const {
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

double NoiseLaw::drawn(std::mt19937_64& random, const EchoConditions& echo, std::uint16_t beam) const {
  const Parts all = parts_of(*this, beam);
  double left = std::uniform_real_distribution<>(0, 1)(random);
  std::size_t k = 0;
  while (k + 1 < all.count && left >= all.all[k].share) left -= all.all[k++].share;
  const Part& part = all.all[k];
  return part.mean + part.scale * deviation(echo, beam) * std::normal_distribution<>()(random);
}

NoiseLaw fitted(const NoiseLaw& like, const RangeErrors& errors, double settled) {
  constexpr int kMostRounds = 300;
  // Some of all ranges may lack the last beams that the law was fitted to.
  const std::size_t beams = std::max({beams_of(errors), like.weight.size(), like.relative.size()});
  NoiseLaw law = like;
  double last = -HUGE_VAL;
  for (int round = 0; round < kMostRounds; ++round) {
    Sums sums;
    for (auto* by_beam : {&sums.far, &sums.of_beam, &sums.squares}) by_beam->resize(beams);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      add(law, double{errors.value[i]}, errors.echo(i), errors.beam[i], sums);
    }
    take(sums, law);
    if (sums.likelihood - last < settled) break;
    last = sums.likelihood;
  }
  return law;
}

}  // namespace crisp
