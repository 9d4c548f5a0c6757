// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include <crisp/points.hpp>

namespace crisp::test {

inline void add(Vectors& cloud, double x, double y, double z) {
  cloud.x.push_back(x);
  cloud.y.push_back(y);
  cloud.z.push_back(z);
}

/// n points spread evenly over a cube of this side [m].
inline Vectors random_cube(std::size_t n, double side, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> along(0, side);
  Vectors cloud;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = along(random);
    const double y = along(random);
    add(cloud, x, y, along(random));
  }
  return cloud;
}

/// n points on three walls of a room's corner, with noise [m] along the normal.
inline Vectors room_corner(std::size_t n, double side, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> along(0, side);
  std::normal_distribution<double> off(0, noise);
  Vectors cloud;
  for (std::size_t i = 0; i < n; ++i) {
    const double a = along(random);
    const double b = along(random);
    const double c = off(random);
    if (i % 3 == 0) add(cloud, c, a, b);
    if (i % 3 == 1) add(cloud, a, c, b);
    if (i % 3 == 2) add(cloud, a, b, c);
  }
  return cloud;
}

inline std::vector<double> random_weights(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> weight(0, 3);
  std::vector<double> weights(n);
  for (double& w : weights) w = weight(random);
  return weights;
}

/// E of equation (10) as it is written: every pair, no truncation.
inline double energy_of_all_pairs(const Vectors& cloud, std::span<const double> weights, double sigma) {
  const double pi = 3.14159265358979323846;
  double sum = 0;
  double total = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double wi = weights.empty() ? 1 : weights[i];
    total += wi;
    for (std::size_t j = 0; j < cloud.size(); ++j) {
      const double wj = weights.empty() ? 1 : weights[j];
      const double d2 = std::pow(cloud.x[i] - cloud.x[j], 2) + std::pow(cloud.y[i] - cloud.y[j], 2) +
                        std::pow(cloud.z[i] - cloud.z[j], 2);
      sum += wi * wj * std::exp(-d2 / (4 * sigma * sigma));
    }
  }
  return sum / (total * total) / std::pow(4 * pi * sigma * sigma, 1.5);
}

}  // namespace crisp::test
