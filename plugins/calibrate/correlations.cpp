// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/correlations.hpp"

#include <algorithm>
#include <cmath>

namespace crisp::calibrate {

std::vector<Correlation> strongest_correlations(const Calibration& calibration, std::size_t most,
                                                double least) {
  const auto& order = calibration.covariance_order;
  const std::size_t m = order.size();
  const auto at = [&](std::size_t row, std::size_t column) {
    return calibration.covariance[row * m + column];
  };
  std::vector<Correlation> all;
  for (std::size_t row = 0; row < m; ++row) {
    for (std::size_t column = 0; column < row; ++column) {
      const double size = std::sqrt(at(row, row) * at(column, column));
      const double value = size > 0 ? at(row, column) / size : 0;
      if (std::abs(value) >= least) all.push_back({order[column], order[row], value});
    }
  }
  std::ranges::sort(all, std::greater(), [](const Correlation& c) { return std::abs(c.value); });
  all.resize(std::min(all.size(), most));
  return all;
}

}  // namespace crisp::calibrate
