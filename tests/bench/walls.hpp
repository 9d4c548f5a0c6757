// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

#include "tests/pipeline/quality/clouds.hpp"

namespace crisp::test {

/// n points on three walls, about so many of them within the cut-off of 7 σ of a point.
inline Vectors walls(std::size_t n, double neighbours, double sigma) {
  const double radius = 7 * sigma;
  const double area = static_cast<double>(n) * std::numbers::pi * radius * radius / neighbours;
  return room_corner(n, std::sqrt(area / 3), 0.3 * sigma, 1);
}

}  // namespace crisp::test
