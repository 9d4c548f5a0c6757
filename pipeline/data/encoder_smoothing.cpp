// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/encoder_smoothing.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cstddef>

namespace crisp {
namespace {

constexpr std::size_t kFewest = 7;   // readings: fewer say little more than the one in their middle
constexpr double kMostChange = 0.6;  // steps: half a step of rounding, and a little for the stamps

/// What the parabola through readings first … last − 1 says at reading i, less what was read there.
double change_at(std::size_t i, std::size_t first, std::size_t last, std::span<const double> times,
                 std::span<const double> angles, double half_width) {
  double t1 = 0, t2 = 0, t3 = 0, t4 = 0;  // Σ tⁿ
  double a0 = 0, a1 = 0, a2 = 0;          // Σ angle · tⁿ
  for (std::size_t k = first; k < last; ++k) {
    const double t = (times[k] - times[i]) / half_width;
    const double angle = angles[k] - angles[i];
    t1 += t;
    t2 += t * t;
    t3 += t * t * t;
    t4 += t * t * t * t;
    a0 += angle;
    a1 += angle * t;
    a2 += angle * t * t;
  }
  const auto n = static_cast<double>(last - first);
  const Eigen::Matrix3d squares{{n, t1, t2}, {t1, t2, t3}, {t2, t3, t4}};
  return squares.inverse().row(0).dot(Eigen::RowVector3d(a0, a1, a2));
}

}  // namespace

std::vector<double> between_steps(std::span<const double> times, std::span<const double> angles, double step,
                                  double half_width) {
  std::vector<double> smooth(angles.begin(), angles.end());
  const double most = kMostChange * step;
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < times.size() && half_width > 0; ++i) {
    while (times[first] < times[i] - half_width) ++first;
    while (last < times.size() && times[last] <= times[i] + half_width) ++last;
    if (last - first < kFewest) continue;
    smooth[i] += std::clamp(change_at(i, first, last, times, angles, half_width), -most, most);
  }
  return smooth;
}

}  // namespace crisp
