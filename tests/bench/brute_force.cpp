// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/bench/rivals.hpp"

namespace crisp::bench {
namespace {

struct Gradient {
  float kernel = 0, x = 0, y = 0, z = 0;
};

Gradient all_on(const float* x, const float* y, const float* z, std::size_t n, std::size_t i, float exponent,
                float floor, float radius2) {
  Gradient sum;
  for (std::size_t j = 0; j < n; ++j) {
    const float dx = x[i] - x[j];
    const float dy = y[i] - y[j];
    const float dz = z[i] - z[j];
    const float distance2 = dx * dx + dy * dy + dz * dz;
    const bool near = distance2 < radius2;
    const float inside =
        std::exp(-exponent * std::min(distance2, radius2));  // numbers that underflow are slow
    const float g = near ? inside : 0.0F;
    sum.kernel += near ? g - floor : 0.0F;
    sum.x += g * dx;
    sum.y += g * dy;
    sum.z += g * dz;
  }
  return sum;
}

}  // namespace

PairSums by_brute_force(const Vectors& cloud, const TruncatedGaussian& kernel) {
  const std::vector<float> x(cloud.x.begin(), cloud.x.end());
  const std::vector<float> y(cloud.y.begin(), cloud.y.end());
  const std::vector<float> z(cloud.z.begin(), cloud.z.end());
  PairSums sums;
  sums.gradient.assign(cloud.size(), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Gradient own =
        all_on(x.data(), y.data(), z.data(), cloud.size(), i, static_cast<float>(kernel.exponent),
               static_cast<float>(kernel.floor), static_cast<float>(kernel.radius * kernel.radius));
    sums.kernel += static_cast<double>(own.kernel);
    sums.gradient.x[i] = static_cast<double>(own.x);
    sums.gradient.y[i] = static_cast<double>(own.y);
    sums.gradient.z[i] = static_cast<double>(own.z);
  }
  return sums;
}

}  // namespace crisp::bench
