// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scene.hpp"

#include <cmath>

namespace crisp::simulate {

Eigen::Vector3d Walk::at(double time) const {
  if (!moves()) return Eigen::Vector3d::Zero();
  double length = 0;
  for (std::size_t i = 1; i < along.size(); ++i) length += (along[i] - along[i - 1]).norm();
  const double gone = std::fmod(speed * std::abs(time), 2 * length);
  double left = gone <= length ? gone : 2 * length - gone;
  for (std::size_t i = 1; i < along.size(); ++i) {
    const double leg = (along[i] - along[i - 1]).norm();
    if (left <= leg && leg > 0) return along[i - 1] + left / leg * (along[i] - along[i - 1]);
    left -= leg;
  }
  return along.back();
}

}  // namespace crisp::simulate
