// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/delay_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace crisp::clock {
namespace {

constexpr double kShortest = 1e-8;  // [s]
const double kRatio = std::log(1.01);

}  // namespace

void DelayHistogram::add(double delay) {
  const double bin = std::log(std::max(delay, kShortest) / kShortest) / kRatio;
  ++bins_[std::min(static_cast<std::size_t>(bin), kBins - 1)];
  ++count_;
}

double DelayHistogram::quantile(double share) const {
  if (count_ == 0) return 0;
  const double requested = share * static_cast<double>(count_);
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    below += bins_[bin];
    if (below > 0 && static_cast<double>(below) >= requested) {
      return kShortest * std::exp(kRatio * (static_cast<double>(bin) + 0.5));
    }
  }
  return kShortest * std::exp(kRatio * kBins);
}

}  // namespace crisp::clock
