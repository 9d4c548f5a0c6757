// SPDX-License-Identifier: BSD-3-Clause
// RQE with gradient beside what else one might compute it with, on walls of a room.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "pipeline/quality/rqe.hpp"
#include "tests/pipeline/quality/clouds.hpp"

namespace {

using namespace crisp;

/// Walls with so many points that a point has about `neighbours` within the radius of 7 σ.
Vectors walls(std::size_t n, double neighbours, double sigma) {
  const double radius = 7 * sigma;
  const double area = static_cast<double>(n) * 3.14159 * radius * radius / neighbours;
  return test::room_corner(n, std::sqrt(area / 3), 0.3 * sigma, 1);
}

void grid(benchmark::State& state) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(2)));
  const auto cloud =
      walls(static_cast<std::size_t>(state.range(0)), static_cast<double>(state.range(1)), 0.02);
  Rqe result;
  for (auto _ : state) result = rqe(cloud.view(), {}, {.sigma = 0.02});
  using benchmark::Counter;
  state.counters["tested/s"] =
      Counter(static_cast<double>(result.tested), Counter::kIsIterationInvariantRate);
  state.counters["pairs/s"] = Counter(static_cast<double>(result.pairs), Counter::kIsIterationInvariantRate);
  state.counters["neighbours"] = 2.0 * static_cast<double>(result.pairs) / static_cast<double>(cloud.size());
}
BENCHMARK(grid)
    ->ArgsProduct({{100000, 1000000}, {10, 100, 1000}, {1}})
    ->Args({1000000, 100, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
