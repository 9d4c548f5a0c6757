// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/residual_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace crisp::diagnose {
namespace {

/// Counts of one laser summed over all simulations.
NoiseCounts together(const std::vector<std::vector<NoiseCounts>>& simulated, std::size_t laser) {
  NoiseCounts sum;
  for (const auto& one : simulated) {
    const NoiseCounts& counts = one.at(laser);
    for (std::size_t b = 0; b < sum.bins.count.size(); ++b) sum.bins.count[b] += counts.bins.count[b];
    sum.bins.all += counts.bins.all;
    sum.squares += counts.squares;
  }
  return sum;
}

double rms_of(const NoiseCounts& counts) {
  return std::sqrt(counts.squares / std::max(1.0, counts.bins.all));
}

/// Density that a single residual adds to a bin.
double share_of_one(const statistics::Histogram& bins) { return 1 / (std::max(1.0, bins.all) * bins.width); }

}  // namespace

std::vector<NoiseCounts> counts_of(const WeightedResiduals& values, const Residuals& residuals,
                                   const std::vector<double>& noise, const Measurements& beams) {
  const std::size_t lasers = beams.laser.empty() ? 0 : std::ranges::max(beams.laser) + std::size_t{1};
  std::vector<NoiseCounts> all(lasers);
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const double unit = noise[k] * residuals.reported[k];
    if (values.weight[k] == 0 || unit == 0) continue;
    NoiseCounts& laser = all[beams.laser[residuals.beam[k]]];
    laser.bins.add(values.value[k] / unit);
    laser.squares += std::pow(values.value[k] / unit, 2);
  }
  return all;
}

std::vector<Distribution> distributions(const std::vector<NoiseCounts>& measured,
                                        const std::vector<std::vector<NoiseCounts>>& simulated) {
  std::vector<Distribution> all;
  for (std::size_t laser = 0; laser < measured.size(); ++laser) {
    const statistics::Histogram& own = measured[laser].bins;
    if (own.all == 0) continue;
    const NoiseCounts expected = together(simulated, laser);
    Distribution one{.laser = laser,
                     .bins = {},
                     .single = share_of_one(own),
                     .measured_rms = rms_of(measured[laser]),
                     .simulated_rms = rms_of(expected)};
    for (std::size_t b = 0; b < own.count.size(); ++b) {
      one.bins.push_back({.at = own.middle(b),
                          .measured = own.count[b] * share_of_one(own),
                          .simulated = expected.bins.count[b] * share_of_one(expected.bins),
                          .error = std::sqrt(own.count[b]) * share_of_one(own)});
    }
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace crisp::diagnose
