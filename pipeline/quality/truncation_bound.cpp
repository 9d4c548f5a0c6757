// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/truncation_bound.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

namespace crisp {

TruncatedGaussian::TruncatedGaussian(double width, double cutoff) : sigma(width) {
  // Far beyond what any scanner sees, and far from where a number's range ends: the peak goes by sigma^-3.
  constexpr double kNarrowest = 1e-6;  // [m]
  constexpr double kWidest = 1e6;      // [m]
  if (!(sigma >= kNarrowest && sigma <= kWidest)) {
    throw Error(fmt::format("the kernel's width is {} m", sigma),
                fmt::format("sigma must lie in {} to {} m; the noise of a range is a good choice", kNarrowest,
                            kWidest));
  }
  if (!(cutoff >= 1 && cutoff <= 12)) {
    throw Error(fmt::format("the kernel's cut-off is {} sigma", cutoff), "it must lie in 1 to 12");
  }
  radius = cutoff * sigma;
  exponent = 1 / (4 * sigma * sigma);
  peak = std::pow(exponent / std::numbers::pi, 1.5);
  floor = std::exp(-0.25 * cutoff * cutoff);
}

namespace {

/// Σ over the offsets o of a cubic lattice of min(G(R), G(least distance of cells o apart)) / G(0).
double sum_over_offsets(const TruncatedGaussian& kernel, double side) {
  // Along one axis, cells m apart leave a gap of (m − 1) sides at least.
  constexpr int kNear = 12;
  std::array<double, kNear + 1> along{};
  double all = 0;  // Σ over every offset of one axis
  double far = 0;  // the part of it beyond kNear
  for (int m = 0;; ++m) {
    const double gap = std::max(m - 1, 0) * side;
    const double g = std::exp(-kernel.exponent * gap * gap);
    const double both_signs = m == 0 ? g : 2 * g;
    all += both_signs;
    if (m <= kNear) {
      along.at(m) = g;
    } else {
      far += both_signs;
      if (both_signs <= 1e-18 * far || both_signs == 0) break;
    }
  }
  double near = 0;
  for (int i = 0; i <= kNear; ++i) {
    for (int j = 0; j <= kNear; ++j) {
      for (int k = 0; k <= kNear; ++k) {
        const int signs = (i == 0 ? 1 : 2) * (j == 0 ? 1 : 2) * (k == 0 ? 1 : 2);
        near += signs * std::min(kernel.floor, along.at(i) * along.at(j) * along.at(k));
      }
    }
  }
  return near + 3 * far * all * all;
}

}  // namespace

}  // namespace crisp

namespace crisp::quality {

double truncation_bound(const TruncatedGaussian& kernel, const SpatialOrder& order,
                        std::span<const double> weights) {
  double sum_of_squares = 0;
  double cell = 0;
  for (std::size_t k = 0; k < order.index.size(); ++k) {
    if (k > 0 && order.cell[k] != order.cell[k - 1]) {
      sum_of_squares += cell * cell;
      cell = 0;
    }
    cell += weights[order.index[k]];
  }
  return sum_over_offsets(kernel, kernel.radius) * (sum_of_squares + cell * cell);
}

}  // namespace crisp::quality
