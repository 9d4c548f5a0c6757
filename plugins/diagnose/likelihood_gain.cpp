// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/likelihood_gain.hpp"

#include <cstddef>
#include <map>

#include "pipeline/quality/resampling.hpp"

namespace crisp {

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
  Gain gain{.metric = "log-likelihood a measurement", .unit = "nat"};
  if (sums.size() < 2) return gain;
  gain.before = all.before / all.count;
  gain.after = all.after / all.count;
  gain.ci95 = bootstrap(sums.size(), 1, seed, kDrawn, [&](const std::vector<std::size_t>& drawn) {
                Sum total;
                for (const std::size_t k : drawn) add(sums[k], total);
                return (total.after - total.before) / total.count;
              }).ci95;
  return gain;
}

}  // namespace crisp
