// SPDX-License-Identifier: BSD-3-Clause
// RQE with its gradient by each of the searches, on walls, at equal truncation. rivals_bench compares it with
// what else one might compute it with.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <crisp/neighbour_search.hpp>
#include <crisp/rqe.hpp>

#include "pipeline/quality/truncation_bound.hpp"
#include "tests/bench/walls.hpp"

namespace crisp {
namespace {

constexpr double kSigma = 0.02;

void count(benchmark::State& state, const Rqe& result, std::size_t n) {
  using benchmark::Counter;
  state.counters["tested/s"] =
      Counter(static_cast<double>(result.tested), Counter::kIsIterationInvariantRate, Counter::kIs1000);
  state.counters["pairs/s"] =
      Counter(static_cast<double>(result.pairs), Counter::kIsIterationInvariantRate, Counter::kIs1000);
  state.counters["neighbours"] = 2.0 * static_cast<double>(result.pairs) / static_cast<double>(n);
}

std::unique_ptr<Search> make_search(const std::string& name) {
  SearchRegistry registry;
  register_built_in(registry);
  return registry.make(name);
}

/// Arguments: points, neighbours, threads. `again`: one search for all, as an optimiser keeps it.
void by_search(benchmark::State& state, const char* name, bool again) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(2)));
  const auto cloud =
      test::walls(static_cast<std::size_t>(state.range(0)), static_cast<double>(state.range(1)), kSigma);
  auto search = make_search(name);
  Rqe result;
  for (auto _ : state) {
    if (!again) search = make_search(name);
    result = rqe(cloud.view(), {}, {.sigma = kSigma, .error_bound = false}, *search);
  }
  count(state, result, cloud.size());
}

/// Wide kernels: σ [cm], on 100 000 points of a 6 m room; the time stops growing where the lattice takes
/// over.
void wide(benchmark::State& state) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto cloud = test::room_corner(100000, 6, 0.01, 1);
  const RqeSettings settings{.sigma = 0.01 * static_cast<double>(state.range(0)), .error_bound = false};
  for (auto _ : state) benchmark::DoNotOptimize(rqe(cloud.view(), {}, settings).value);
}

BENCHMARK_CAPTURE(by_search, flann, "flann", false)->Args({100000, 100, 1});
BENCHMARK_CAPTURE(by_search, exact, "exact", false)->Args({10000, 100, 1});
BENCHMARK_CAPTURE(by_search, grid, "grid", false)
    ->ArgsProduct({{100000, 1000000}, {10, 30, 100, 300, 1000}, {1}});
BENCHMARK_CAPTURE(by_search, grid_again, "grid", true)
    ->ArgsProduct({{100000, 1000000}, {10, 30, 100, 300, 1000}, {1}});
BENCHMARK_CAPTURE(by_search, grid_threads, "grid", false)
    ->ArgsProduct({{1000000}, {100}, {1, 2}})
    ->UseRealTime();
BENCHMARK_CAPTURE(by_search, grid_again_threads, "grid", true)
    ->ArgsProduct({{1000000}, {100}, {1, 2}})
    ->UseRealTime();
BENCHMARK(wide)->Arg(5)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Arg(40)->Arg(60);

}  // namespace
}  // namespace crisp
