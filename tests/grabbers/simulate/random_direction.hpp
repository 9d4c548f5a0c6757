// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "pipeline/statistics/random_stream.hpp"

namespace crisp::test {

/// A direction, all equally likely; one number after the other, since arguments are evaluated in any order.
inline Eigen::Vector3d random_direction(statistics::RandomStream& random) {
  const double z = random.normal();
  const double y = random.normal();
  const double x = random.normal();
  return Eigen::Vector3d(x, y, z).normalized();
}

}  // namespace crisp::test
