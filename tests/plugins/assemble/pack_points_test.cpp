// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/assemble/pack_points.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "tests/support/instruction_sets.hpp"

namespace crisp {
namespace {

class PackPoints : public test::EachInstructionSet {};

INSTANTIATE_TEST_SUITE_P(All, PackPoints, testing::ValuesIn(test::instruction_sets()),
                         test::name_of_instruction_set);

TEST_P(PackPoints, EveryFieldOfEachPointIsWrittenWhateverTheirNumber) {
  constexpr std::size_t kMax = 40;  // some of the longest vectors, and all that can be left behind them
  std::vector<double> x(kMax), y(kMax), z(kMax), time(kMax);
  std::iota(x.begin(), x.end(), 1.1);
  std::iota(y.begin(), y.end(), -200.2);
  std::iota(z.begin(), z.end(), 0.3);
  std::iota(time.begin(), time.end(), 1e4 + 1e-9);
  std::vector<float> intensity(kMax);
  std::iota(intensity.begin(), intensity.end(), 0.5F);
  std::vector<std::uint16_t> laser(kMax), beam(kMax);
  std::iota(laser.begin(), laser.end(), 7);
  std::iota(beam.begin(), beam.end(), 65500);
  for (std::size_t n = 0; n <= kMax; ++n) {
    std::vector<Point, Eigen::aligned_allocator<Point>> points(n + 1);
    simd::pack_points({.x = x.data(),
                       .y = y.data(),
                       .z = z.data(),
                       .intensity = intensity.data(),
                       .laser = laser.data(),
                       .beam = beam.data(),
                       .time = time.data(),
                       .size = n},
                      points.data());
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(points[i].x, static_cast<float>(x[i])) << i << " of " << n;
      EXPECT_EQ(points[i].y, static_cast<float>(y[i])) << i << " of " << n;
      EXPECT_EQ(points[i].z, static_cast<float>(z[i])) << i << " of " << n;
      EXPECT_EQ(points[i].data[3], 1) << i << " of " << n;
      EXPECT_EQ(points[i].intensity, intensity[i]) << i << " of " << n;
      EXPECT_EQ(points[i].laser, laser[i]) << i << " of " << n;
      EXPECT_EQ(points[i].beam, beam[i]) << i << " of " << n;
      EXPECT_EQ(points[i].time, time[i]) << i << " of " << n;
    }
    EXPECT_EQ(points[n].time, 0) << "what lies behind the last of " << n << " is left alone";
  }
}

}  // namespace
}  // namespace crisp
