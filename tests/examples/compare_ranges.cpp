// SPDX-License-Identifier: BSD-3-Clause
// compare_ranges BEAMS.pcd DRIFTED.pcd RATE: do the ranges of the second recording fall behind the first's by
// RATE m/s?
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <crisp/measurement_tables.hpp>

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const auto plain = crisp::measurements_of(crisp::read_pcd(argv[1])).beams;
  const auto drifted = crisp::measurements_of(crisp::read_pcd(argv[2])).beams;
  const double rate = std::atof(argv[3]);
  if (plain.size() < 1000 || plain.size() != drifted.size()) {
    std::fprintf(stderr, "%zu and %zu measurements\n", plain.size(), drifted.size());
    return 1;
  }
  const auto lag = [&](std::size_t i) {
    return static_cast<double>(plain.range[i]) - static_cast<double>(drifted.range[i]) - rate * plain.time[i];
  };
  double worst = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) worst = std::max(worst, std::abs(lag(i) - lag(0)));
  std::printf("largest difference from the drift: %.6f m\n", worst);
  constexpr double kRounding = 2.1e-3;  // [m] each of the four ranges is rounded to 1 mm
  return worst < kRounding ? 0 : 1;
}
