// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/likelihood_gain.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>

#include "pipeline/statistics/bootstrap.hpp"

namespace crisp::diagnose {
namespace {

constexpr const char* kMetric = "log-likelihood a measurement";

/// [nat] Held-out increase of the log-likelihood per range, if it was evaluated.
std::optional<double> rise_of(const std::vector<Gain>& gains) {
  const auto gain = std::ranges::find(gains, kMetric, &Gain::metric);
  if (gain == gains.end()) return std::nullopt;
  return std::max(0.0, gain->after - gain->before);
}

}  // namespace

Gain likelihood_gain(const std::vector<double>& before, const std::vector<double>& after,
                     const std::vector<std::uint32_t>& block, std::uint64_t seed) {
  constexpr std::size_t kDrawn = 999;
  struct Sum {
    double count = 0, before = 0, after = 0;
  };
  std::map<std::uint32_t, Sum> by_block;
  for (std::size_t i = 0; i < before.size(); ++i) {
    Sum& sum = by_block[block[i]];
    sum.count += 1;
    sum.before += before[i];
    sum.after += after[i];
  }
  std::vector<Sum> sums;
  Sum all;
  const auto add = [](const Sum& one, Sum& to) {
    to.count += one.count;
    to.before += one.before;
    to.after += one.after;
  };
  for (const auto& [number, sum] : by_block) {
    sums.push_back(sum);
    add(sum, all);
  }
  Gain gain{.metric = kMetric, .unit = "nat"};
  if (sums.size() < 2) return gain;
  gain.before = all.before / all.count;
  gain.after = all.after / all.count;
  gain.ci95 = statistics::bootstrap(sums.size(), 1, seed, kDrawn, [&](const std::vector<std::size_t>& drawn) {
                Sum total;
                for (const std::size_t k : drawn) add(sums[k], total);
                return (total.after - total.before) / total.count;
              }).ci95;
  return gain;
}

void share_explained(std::span<Finding> findings, std::span<const UnnamedFinding> unnamed) {
  double all = 0;
  for (const Finding& finding : findings) all += rise_of(finding.gain).value_or(0);
  for (const UnnamedFinding& finding : unnamed) all += rise_of(finding.gain).value_or(0);
  for (Finding& finding : findings) {
    const auto own = rise_of(finding.gain);
    if (own) finding.explained_fraction = all > 0 ? *own / all : 0;
  }
}

}  // namespace crisp::diagnose
