// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/expectation_step.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/quality/blocks.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::size_t kRangesAtOnce = 512;     // ranges: their arrays stay in the cache
constexpr std::size_t kRangesOfTask = 16'384;  // ranges that one thread sums

using RangeArray = std::array<double, kRangesAtOnce>;

/// Scale, peak and tail of a mixture component.
struct ComponentKind {
  double scale = 1;
  bool far = false;
  bool tail = false;
};

/// Expected square of a range, relative to the scales of its component and beam.
struct ExpectedSquare {
  double square = 0;
  double weight = 0;  ///< sum of the components' posterior probabilities
};

std::vector<ComponentKind> components_of(const NoiseModel& model) {
  std::vector<ComponentKind> kinds;
  for (const bool far : {false, true}) {
    if (far && !model.has_peaks()) break;
    kinds.push_back({.far = far});
    if (model.has_tail) kinds.push_back({.scale = model.tail_scale, .far = far, .tail = true});
  }
  return kinds;
}

}  // namespace

/// A block of ranges with the results of its E-step.
struct ExpectationStep::Block {
  std::size_t first = 0;
  std::size_t size = 0;
  const std::vector<ComponentKind>* kinds = nullptr;
  RangeArray value{}, weight{}, relative{}, deviation{}, log_density{};
  std::array<RangeArray, MixtureBlock::kMaxComponents> share{}, mean{}, probability{};

  /// Evaluates the mixture for the ranges of the block.
  void compute(const NoiseModel& model, const RangeErrors& errors,
               const std::array<std::vector<double>, model::kVarianceParts>& unit_variances) {
    deviation.fill(0);
    for (std::size_t part = 0; part < model::kVarianceParts; ++part) {
      const double square = model.size[part] * model.size[part];
      if (square == 0) continue;
      const double* unit = unit_variances[part].data() + first;
      for (std::size_t k = 0; k < size; ++k) deviation[k] += square * unit[k];
    }
    for (std::size_t k = 0; k < size; ++k) {
      const std::uint16_t beam = errors.beam[first + k];
      value[k] = double{errors.value[first + k]};
      weight[k] = model.has_peaks() ? model.weight[beam] : 0;
      relative[k] = model.has_relative() ? model.relative[beam] : 1;
      deviation[k] = relative[k] * std::sqrt(deviation[k]);
    }
    const double in_tail = model.has_tail ? model.tail_share : 0;
    MixtureBlock mixture{.size = size,
                         .value = value.data(),
                         .deviation = deviation.data(),
                         .components = kinds->size(),
                         .component = {},
                         .log_density = log_density.data()};
    for (std::size_t c = 0; c < kinds->size(); ++c) {
      const ComponentKind& kind = (*kinds)[c];
      const double of_peak = kind.tail ? in_tail : 1 - in_tail;
      for (std::size_t k = 0; k < size; ++k) {
        share[c][k] = of_peak * (kind.far ? weight[k] : 1 - weight[k]);
        mean[c][k] = model.separation * ((kind.far ? 1 : 0) - weight[k]);
      }
      mixture.component[c] = {.share = share[c].data(),
                              .mean = mean[c].data(),
                              .scale = kind.scale,
                              .probability = probability[c].data()};
    }
    simd::expect(mixture);
  }

  /// Adds the range's share in the tail and in the peaks to the sums.
  ExpectedSquare add_components(std::size_t k, const NoiseModel& model, std::uint16_t beam,
                                ExpectationSums& sums) const {
    ExpectedSquare expected;
    for (std::size_t c = 0; c < kinds->size(); ++c) {
      const ComponentKind& kind = (*kinds)[c];
      const double p = probability[c][k];
      const double off = value[k] - mean[c][k];
      const double usual = off / (kind.scale * relative[k]);
      expected.square += p * usual * usual;
      expected.weight += p;
      if (kind.tail) {
        sums.tail += p;
        sums.tail_squares += p * (off / deviation[k]) * (off / deviation[k]);
      }
      if (!model.has_peaks()) continue;
      const double lever = (kind.far ? 1 : 0) - weight[k];
      const double precision = p / ((kind.scale * deviation[k]) * (kind.scale * deviation[k]));
      sums.separation += precision * value[k] * lever;
      sums.separation_weight += precision * lever * lever;
      if (kind.far) sums.far[beam] += p;
    }
    return expected;
  }
};

ExpectationSums::ExpectationSums(std::size_t beams) : far(beams), of_beam(beams), squares(beams) {}

void ExpectationSums::operator+=(const ExpectationSums& other) {
  ranges += other.ranges;
  log_likelihood += other.log_likelihood;
  tail += other.tail;
  tail_squares += other.tail_squares;
  separation += other.separation;
  separation_weight += other.separation_weight;
  variance += other.variance;
  const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
    std::ranges::transform(to, from, to.begin(), std::plus());
  };
  add(far, other.far);
  add(of_beam, other.of_beam);
  add(squares, other.squares);
}

ExpectationStep::ExpectationStep(const RangeErrors& errors) : errors_(errors) {
  for (auto& part : unit_variances_) part.resize(errors.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const model::ByPart units = model::unit_variances(errors.echo(i));
    for (std::size_t part = 0; part < model::kVarianceParts; ++part) unit_variances_[part][i] = units[part];
  }
}

void ExpectationStep::for_each_block(const NoiseModel& model, std::size_t begin, std::size_t end,
                                     const std::function<void(const Block&)>& use) const {
  const auto kinds = components_of(model);
  Block block;
  block.kinds = &kinds;
  for (block.first = begin; block.first < end; block.first += kRangesAtOnce) {
    block.size = std::min(kRangesAtOnce, end - block.first);
    block.compute(model, errors_, unit_variances_);
    use(block);
  }
}

void ExpectationStep::add(const Block& block, const NoiseModel& model, ExpectationSums& sums) const {
  for (std::size_t k = 0; k < block.size; ++k) {
    const std::uint16_t beam = errors_.beam[block.first + k];
    sums.ranges += 1;
    sums.log_likelihood += block.log_density[k];
    sums.of_beam[beam] += 1;
    const ExpectedSquare expected = block.add_components(k, model, beam, sums);
    if (!(expected.weight > 0)) continue;  // underflow: an extreme outlier
    const double relative = block.relative[k];
    const double variance = (block.deviation[k] / relative) * (block.deviation[k] / relative);
    model::ByPart units;
    for (std::size_t part = 0; part < model::kVarianceParts; ++part) {
      units[part] = model.parts[part] ? unit_variances_[part][block.first + k] : 0;
    }
    sums.variance.add(units, expected.square / expected.weight, expected.weight / (variance * variance));
    sums.squares[beam] += expected.square / variance * relative * relative;
  }
}

ExpectationSums ExpectationStep::sums(const NoiseModel& model, std::size_t beams) const {
  const auto add_ranges = [&](ExpectationSums& sums, std::size_t begin, std::size_t end) {
    for_each_block(model, begin, end, [&](const Block& block) { add(block, model, sums); });
  };
  return quality::sum_over_blocks(errors_.size(), kRangesOfTask, ExpectationSums(beams), add_ranges);
}

std::vector<double> ExpectationStep::log_densities(const NoiseModel& model) const {
  std::vector<double> all(errors_.size());
  quality::for_blocks(all.size(), kRangesOfTask, [&](std::size_t, std::size_t begin, std::size_t end) {
    for_each_block(model, begin, end, [&](const Block& block) {
      std::copy_n(block.log_density.begin(), block.size,
                  all.begin() + static_cast<std::ptrdiff_t>(block.first));
    });
  });
  return all;
}

}  // namespace crisp::diagnose
