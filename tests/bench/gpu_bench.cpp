// SPDX-License-Identifier: BSD-3-Clause
// RQE with its gradient on a graphics processor, side by side with all threads of the processor, on walls;
// and what the former's time goes to. Arguments: points, neighbours.
#include <benchmark/benchmark.h>

#include <crisp/rqe.hpp>

#include "pipeline/quality/searches.hpp"
#include "pipeline/quality/truncation_bound.hpp"
#include "plugins/cuda/gpu.hpp"
#include "tests/bench/walls.hpp"

namespace crisp {
namespace {

using namespace crisp::quality;

constexpr RqeSettings kSettings{.sigma = 0.02, .error_bound = false};

Vectors cloud_of(const benchmark::State& state) {
  return test::walls(static_cast<std::size_t>(state.range(0)), static_cast<double>(state.range(1)),
                     kSettings.sigma);
}

/// Again and again with one search, as an optimiser keeps it.
void measure(benchmark::State& state, Search& search) {
  const auto cloud = cloud_of(state);
  Rqe result = rqe(cloud.view(), {}, kSettings, search);
  for (auto _ : state) result = rqe(cloud.view(), {}, kSettings, search);
  state.counters["pairs"] = static_cast<double>(result.pairs);
}

void processor(benchmark::State& state) {
  GridSearch search;
  measure(state, search);
}

void graphics_processor(benchmark::State& state) {
  if (const std::string reason = cuda::why_no_gpu(); !reason.empty())
    return state.SkipWithError(reason.c_str());
  cuda::UnitSearch search(cuda::take_plan_to_gpu);
  measure(state, search);
}

/// What the processor does before a cloud that it has not seen.
void plan(benchmark::State& state) {
  const auto cloud = cloud_of(state);
  const double radius = TruncatedGaussian(kSettings.sigma, kSettings.cutoff).radius;
  for (auto _ : state) benchmark::DoNotOptimize(cuda::plan_cells(cloud.view(), radius).tested);
}

BENCHMARK(processor)
    ->ArgsProduct({{100000, 1000000, 10000000}, {100, 1000}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(graphics_processor)
    ->ArgsProduct({{100000, 1000000, 10000000}, {100, 1000}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(plan)
    ->ArgsProduct({{100000, 1000000, 10000000}, {100, 1000}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace crisp
