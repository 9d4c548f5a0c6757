// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise_law.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace crisp {
namespace {

/// One of the up to four normal laws that a range may have come from.
struct Part {
  double share = 1;
  double mean = 0;
  double scale = 1;  // of σ(r)
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

double sigma_at(const NoiseLaw& law, double range, std::uint16_t beam) {
  const double spread = law.has_spread() ? law.spread[beam] : 1;
  return spread * std::hypot(law.sigma, law.slope * range);
}

/// Sums of one round of expectation.
struct Sums {
  double all = 0, likelihood = 0, tail = 0, tail_squares = 0;
  double separation = 0, separation_weight = 0;
  // regression of squares on 1 and r²: σ² and slope²
  double w = 0, wr = 0, wrr = 0, wy = 0, wry = 0;
  std::vector<double> far, of_beam, squares;  // by beam
};

void add(const NoiseLaw& law, double value, double range, std::uint16_t beam, Sums& sums) {
  const Parts parts = parts_of(law, beam);
  const double sigma = sigma_at(law, range, beam);
  const double spread = law.has_spread() ? law.spread[beam] : 1;
  std::array<double, 4> probable{};
  double total = 1e-300;
  for (std::size_t k = 0; k < parts.count; ++k) {
    probable[k] = density(parts.all[k], value, sigma);
    total += probable[k];
  }
  sums.all += 1;
  sums.likelihood += std::log(total);
  sums.of_beam[beam] += 1;
  const double variance = std::pow(sigma / spread, 2);
  const double square_range = range * range;
  for (std::size_t k = 0; k < parts.count; ++k) {
    const Part& part = parts.all[k];
    const double p = probable[k] / total;
    const double square = std::pow((value - part.mean) / (part.scale * spread), 2);
    const double w = p / (variance * variance);
    sums.w += w;
    sums.wr += w * square_range;
    sums.wrr += w * square_range * square_range;
    sums.wy += w * square;
    sums.wry += w * square_range * square;
    sums.squares[beam] += p * square / variance * spread * spread;
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
}

void take_variance(const Sums& sums, NoiseLaw& law) {
  constexpr double kLeast = 1e-10;  // [m²]
  double variance = sums.wy / sums.w;
  double slope = 0;
  if (law.has_slope) {
    const double determinant = sums.w * sums.wrr - sums.wr * sums.wr;
    if (determinant > 1e-9 * sums.w * sums.wrr) {
      slope = std::max(0.0, (sums.w * sums.wry - sums.wr * sums.wy) / determinant);
    }
    variance = (sums.wy - slope * sums.wr) / sums.w;
  }
  law.sigma = std::sqrt(std::max(kLeast, variance));
  law.slope = std::sqrt(slope);
}

/// About 1, so that sigma is that of a usual beam.
void take_spread(const Sums& sums, NoiseLaw& law) {
  double logarithms = 0;
  double beams = 0;
  for (std::size_t b = 0; b < law.spread.size(); ++b) {
    law.spread[b] = std::sqrt((sums.squares[b] + 1) / (sums.of_beam[b] + 1));
    if (sums.of_beam[b] == 0) continue;
    logarithms += std::log(law.spread[b]);
    beams += 1;
  }
  const double usual = std::exp(logarithms / std::max(1.0, beams));
  for (double& spread : law.spread) spread /= usual;
  law.sigma *= usual;
  law.slope *= usual;
}

void take(const Sums& sums, NoiseLaw& law) {
  constexpr double kLeastScale = 1.5;
  take_variance(sums, law);
  if (law.has_spread()) take_spread(sums, law);
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

std::size_t beams_of(const RangeErrors& errors) {
  return errors.beam.empty() ? 0 : std::ranges::max(errors.beam) + std::size_t{1};
}

double NoiseLaw::variance(double range, std::uint16_t beam) const {
  const double tail = has_tail ? tail_share * (tail_scale * tail_scale - 1) : 0;
  const double far = has_peaks() ? weight[beam] : 0;
  return std::pow(sigma_at(*this, range, beam), 2) * (1 + tail) + separation * separation * far * (1 - far);
}

double NoiseLaw::log_density(double value, double range_m, std::uint16_t beam) const {
  const Parts parts = parts_of(*this, beam);
  const double sigma_here = sigma_at(*this, range_m, beam);
  double sum = 1e-300;
  for (std::size_t k = 0; k < parts.count; ++k) sum += density(parts.all[k], value, sigma_here);
  return std::log(sum);
}

NoiseLaw fitted(const NoiseLaw& like, const RangeErrors& errors) {
  constexpr int kMostRounds = 300;
  constexpr double kSettled = 0.02;  // [nat] that a round brings
  const std::size_t beams = beams_of(errors);
  NoiseLaw law = like;
  double last = -HUGE_VAL;
  for (int round = 0; round < kMostRounds; ++round) {
    Sums sums;
    for (auto* by_beam : {&sums.far, &sums.of_beam, &sums.squares}) by_beam->resize(beams);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      add(law, double{errors.value[i]}, double{errors.range[i]}, errors.beam[i], sums);
    }
    take(sums, law);
    if (sums.likelihood - last < kSettled) break;
    last = sums.likelihood;
  }
  return law;
}

}  // namespace crisp
