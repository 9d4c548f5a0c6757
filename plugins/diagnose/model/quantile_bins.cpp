// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/quantile_bins.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace crisp::diagnose {
namespace {

constexpr std::size_t kBins = 12;

/// End of each quantile bin; equal values share a bin.
///
/// @param sorted  from `begin` to `end`
std::vector<std::size_t> ends_of_bins(const std::vector<double>& sorted, std::size_t begin, std::size_t end,
                                      std::size_t bins) {
  std::vector<std::size_t> ends;
  std::size_t last = begin;
  for (std::size_t b = 0; b < bins; ++b) {
    std::size_t next = begin + (b + 1) * (end - begin) / bins;
    while (next > last && next < end && sorted[next] == sorted[next - 1]) ++next;
    if (next <= last) continue;
    ends.push_back(next);
    last = next;
  }
  return ends;
}

}  // namespace

QuantileBins quantile_bins(const std::vector<std::uint32_t>& members, const std::vector<double>& values,
                           const std::function<std::size_t(double value)>& recording) {
  std::vector<std::size_t> order(members.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return values[k]; });
  QuantileBins layout{.profile = {}, .residual = {}, .first = {0}};
  std::vector<double> sorted;
  for (const std::size_t k : order) {
    sorted.push_back(values[k]);
    layout.residual.push_back(members[k]);
  }
  while (layout.first.back() < sorted.size()) {
    const std::size_t begin = layout.first.back();
    const std::size_t number = recording(sorted[begin]);
    const auto rest = std::span(sorted).subspan(begin);
    const auto count =
        static_cast<std::size_t>(std::ranges::upper_bound(rest, number, {}, recording) - rest.begin());
    const std::size_t bins = std::max<std::size_t>(1, (kBins * count + sorted.size() / 2) / sorted.size());
    for (const std::size_t end : ends_of_bins(sorted, begin, begin + count, bins)) {
      const std::span own = std::span(sorted).subspan(layout.first.back(), end - layout.first.back());
      const double sum = std::accumulate(own.begin(), own.end(), 0.0);
      layout.profile.bins.push_back({.at = sum / static_cast<double>(own.size()), .recording = number});
      layout.first.push_back(end);
    }
  }
  return layout;
}

}  // namespace crisp::diagnose
