// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace crisp::statistics {

/// Histogram of equal bins. Values outside the bins count in `all` only.
struct Histogram {
  double first = 0, width = 1;  // lower end of the first bin, width of each
  std::vector<double> count;
  double all = 0;

  Histogram(double from, double to, std::size_t bins)
      : first(from), width((to - from) / static_cast<double>(bins)), count(bins) {}
  void add(double value) {
    all += 1;
    const double bin = std::floor((value - first) / width);
    if (bin >= 0 && bin < static_cast<double>(count.size())) count[static_cast<std::size_t>(bin)] += 1;
  }
  double middle(std::size_t bin) const { return first + (static_cast<double>(bin) + 0.5) * width; }
};

}  // namespace crisp::statistics
