// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/peak_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "pipeline/quality/blocks.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::size_t kWeights = 201;  // grid of weights from 0 to 1
constexpr double kStep = 1.0 / (kWeights - 1);

using ByWeight = std::array<double, kWeights>;

double weight_at(std::size_t k) { return kStep * static_cast<double>(k); }

/// Density of a value about one peak, up to a common factor.
double density_about(double off, double sigma, const NoiseModel& model) {
  const double z = off / sigma;
  const double inner = std::exp(-z * z / 2);
  if (!model.has_tail) return inner;
  const double outer = z / model.tail_scale;
  return (1 - model.tail_share) * inner + model.tail_share / model.tail_scale * std::exp(-outer * outer / 2);
}

/// The ranges of one beam.
struct OfBeam {
  std::uint16_t beam = 0;
  std::vector<double> value, sigma;  // [m]
};

std::vector<OfBeam> by_beam(const NoiseModel& model, const RangeErrors& errors) {
  std::vector<OfBeam> beams(beams_of(errors));
  for (std::size_t i = 0; i < errors.size(); ++i) {
    OfBeam& one = beams[errors.beam[i]];
    one.beam = errors.beam[i];
    one.value.push_back(double{errors.value[i]});
    one.sigma.push_back(model.deviation(errors.echo(i), errors.beam[i]));
  }
  std::erase_if(beams, [](const OfBeam& one) { return one.value.empty(); });
  return beams;
}

/// Log-likelihood of each weight where the nearer peak lies at `near` [m].
ByWeight with_peak_at(double near, const OfBeam& beam, const NoiseModel& model) {
  constexpr std::size_t kBeforeUnderflow = 64;  // number of factors
  constexpr double kMin = 1e-4;                 // relative density of outliers, which belong to neither peak
  ByWeight logarithm{};
  ByWeight product;
  product.fill(1);
  for (std::size_t i = 0; i < beam.value.size(); ++i) {
    const double off = beam.value[i] - near;
    const double nearer = density_about(off, beam.sigma[i], model) + kMin;
    const double farther = density_about(off - model.separation, beam.sigma[i], model) + kMin;
    for (std::size_t k = 0; k < kWeights; ++k) product[k] *= std::lerp(nearer, farther, weight_at(k));
    if (i % kBeforeUnderflow != kBeforeUnderflow - 1 && i + 1 != beam.value.size()) continue;
    for (std::size_t k = 0; k < kWeights; ++k) logarithm[k] += std::log(product[k]);
    product.fill(1);
  }
  return logarithm;
}

/// Marginal likelihood of each weight of one beam, summed over the peaks' position, up to a factor.
ByWeight likelihood_of(const OfBeam& beam, const NoiseModel& model) {
  constexpr int kPlaces = 10;     // on either side
  constexpr double kApart = 0.8;  // grid spacing in standard errors of a mean
  const double error = beam.sigma.front() / std::sqrt(static_cast<double>(beam.value.size()));
  const double apart = std::min(
      kApart * error, model.separation / 2 / kPlaces);  // to stay nearer to this peak than to the other
  const double middle = -model.separation * model.weight[beam.beam];
  std::array<ByWeight, 2 * kPlaces + 1> logarithms{};
  double most = -HUGE_VAL;
  for (std::size_t place = 0; place < logarithms.size(); ++place) {
    auto& own = logarithms.at(place);
    own = with_peak_at(middle + (static_cast<double>(place) - kPlaces) * apart, beam, model);
    most = std::max(most, std::ranges::max(own));
  }
  ByWeight likelihood{};
  for (const ByWeight& own : logarithms) {
    for (std::size_t k = 0; k < kWeights; ++k) likelihood[k] += std::exp(own[k] - most);
  }
  return likelihood;
}

/// Cumulative integral from 0.
ByWeight integral_of(const ByWeight& likelihood) {
  ByWeight sum{};
  for (std::size_t k = 1; k < kWeights; ++k) {
    sum[k] = sum[k - 1] + kStep / 2 * (likelihood[k - 1] + likelihood[k]);
  }
  return sum;
}

/// Log-likelihood of the limits weight_at(first) and weight_at(last).
double likelihood_between(std::size_t first, std::size_t last, const std::vector<ByWeight>& integrals) {
  constexpr double kNone = 1e-300;
  double sum = 0;
  for (const ByWeight& integral : integrals) sum += std::log(integral[last] - integral[first] + kNone);
  return sum - static_cast<double>(integrals.size()) * std::log(weight_at(last - first));
}

/// Posterior moments of the limits on the grid.
struct Moments {
  double all = 0, sum = 0, squares = 0;

  void add(double value, double likelihood) {
    all += likelihood;
    sum += likelihood * value;
    squares += likelihood * value * value;
  }
  double mean() const { return sum / all; }
  /// Standard deviation, including that of the grid's steps.
  double error() const {
    return std::sqrt(std::max(0.0, squares / all - mean() * mean()) + kStep * kStep / 12);
  }
};

}  // namespace

WeightLimits weight_limits(const NoiseModel& model, const RangeErrors& errors) {
  const std::vector<OfBeam> beams = by_beam(model, errors);
  std::vector<ByWeight> integrals(beams.size());
  quality::for_each_index(beams.size(),
                          [&](std::size_t b) { integrals[b] = integral_of(likelihood_of(beams[b], model)); });
  std::vector<std::vector<double>> logarithms(kWeights);
  quality::for_each_index(kWeights, [&](std::size_t first) {
    for (std::size_t last = first + 1; last < kWeights; ++last) {
      logarithms[first].push_back(likelihood_between(first, last, integrals));
    }
  });
  double most = -HUGE_VAL;
  for (const auto& own : logarithms) most = own.empty() ? most : std::max(most, std::ranges::max(own));
  Moments lower;
  Moments upper;
  for (std::size_t first = 0; first < kWeights; ++first) {
    for (std::size_t k = 0; k < logarithms[first].size(); ++k) {
      const double likelihood = std::exp(logarithms[first][k] - most);
      lower.add(weight_at(first), likelihood);
      upper.add(weight_at(first + 1 + k), likelihood);
    }
  }
  return {
      .least = lower.mean(), .most = upper.mean(), .least_error = lower.error(), .most_error = upper.error()};
}

}  // namespace crisp::diagnose
