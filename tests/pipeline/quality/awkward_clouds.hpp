// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <map>
#include <string>

#include "tests/pipeline/quality/clouds.hpp"

namespace crisp::test {

/// Clouds that neighbour searches stumble over.
inline std::map<std::string, Vectors> awkward_clouds() {
  std::map<std::string, Vectors> clouds;
  clouds["random"] = random_cube(600, 1, 1);
  clouds["walls"] = room_corner(600, 1, 0.005, 2);
  clouds["a flat plane"] = room_corner(600, 1, 0, 3);
  clouds["sparse"] = random_cube(300, 30, 4);
  clouds["one point"] = random_cube(1, 1, 5);
  clouds["two points"] = random_cube(2, 0.05, 6);
  clouds["three points"] = random_cube(3, 0.1, 7);
  clouds["17 points, one more than a tile"] = random_cube(17, 0.05, 8);
  clouds["129 points, one more than a group"] = random_cube(129, 0.5, 9);
  for (int i = 0; i < 200; ++i) {
    add(clouds["all points equal"], 3, 3, 3);
    const int half = i / 2;
    const int row = i / 6;
    const int layer = i / 36;
    add(clouds["each point twice"], 0.01 * half, 1, 0.03 * (half % 7));
    add(clouds["a lattice as wide as the radius"], 0.1 * (i % 6), 0.1 * (row % 6), 0.1 * layer);
    add(clouds["a line"], 0.013 * i, 0, 0);
  }
  clouds["huge coordinates"] = random_cube(600, 1, 10);
  for (double& x : clouds["huge coordinates"].x) x -= 5.2e6;
  clouds["outliers"] = random_cube(600, 1, 11);
  add(clouds["outliers"], 1e12, 1e12, -1e12);
  add(clouds["outliers"], 1e12, 1e12, -1e12);
  add(clouds["outliers"], -1e9, 0, 0);
  return clouds;
}

/// How many pairs are from `low` to `high` apart.
inline double pairs_between(const Vectors& cloud, double low, double high) {
  double pairs = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = std::sqrt(squared_distance(cloud.view(), i, j));
      if (distance >= low && distance <= high) ++pairs;
    }
  }
  return pairs;
}

}  // namespace crisp::test
