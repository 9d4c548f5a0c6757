// SPDX-License-Identifier: BSD-3-Clause
// RQE with its gradient, beside what else one might compute it with: on walls, at equal truncation.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <array>
#include <ctime>
#include <nanoflann.hpp>

#include "pipeline/quality/kernel.hpp"
#include "pipeline/quality/rqe.hpp"
#include "pipeline/quality/search.hpp"
#include "tests/pipeline/quality/clouds.hpp"

namespace crisp {
namespace {

constexpr double kSigma = 0.02;

/// n points on three walls, about so many of them within the cut-off of 7 σ of a point.
Vectors walls(std::int64_t n, std::int64_t neighbours) {
  const double radius = 7 * kSigma;
  const double area = static_cast<double>(n) * 3.14159 * radius * radius / static_cast<double>(neighbours);
  return test::room_corner(static_cast<std::size_t>(n), std::sqrt(area / 3), 0.3 * kSigma, 1);
}

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
  const auto cloud = walls(state.range(0), state.range(1));
  auto search = make_search(name);
  Rqe result;
  for (auto _ : state) {
    if (!again) search = make_search(name);
    result = rqe(cloud.view(), {}, {.sigma = kSigma, .error_bound = false}, *search);
  }
  count(state, result, cloud.size());
}

/// By which power of the number of points the cost grows at the same density, from n to 10 n.
void exponent(benchmark::State& state) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const std::array<Vectors, 2> clouds{walls(state.range(0), 100), walls(10 * state.range(0), 100)};
  std::array<double, 2> seconds{};
  for (auto _ : state) {
    for (std::size_t k = 0; k < 2; ++k) {
      const std::clock_t start = std::clock();
      benchmark::DoNotOptimize(rqe(clouds.at(k).view(), {}, {.sigma = kSigma}).value);
      seconds.at(k) += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    }
  }
  state.counters["exponent"] = std::log10(seconds[1] / seconds[0]);
}

/// Wide kernels: σ [cm], on 100 000 points of a 6 m room; the time stops growing where the lattice takes
/// over.
void wide(benchmark::State& state) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto cloud = test::room_corner(100000, 6, 0.01, 1);
  const RqeSettings settings{.sigma = 0.01 * static_cast<double>(state.range(0)), .error_bound = false};
  for (auto _ : state) benchmark::DoNotOptimize(rqe(cloud.view(), {}, settings).value);
}

/// What nanoflann needs to know of the points.
struct CloudForNanoflann {
  const Vectors& cloud;
  std::size_t kdtree_get_point_count() const { return cloud.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return axis == 0 ? cloud.x[i] : axis == 1 ? cloud.y[i] : cloud.z[i];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// A k-d tree, a radius search and std::exp for each point: how most people would write it.
void by_nanoflann(benchmark::State& state) {
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, CloudForNanoflann>,
                                                   CloudForNanoflann, 3>;
  const auto cloud = walls(state.range(0), state.range(1));
  const TruncatedGaussian kernel(kSigma, 7);
  const auto points = cloud.view();
  Rqe result;
  for (auto _ : state) {
    const CloudForNanoflann adaptor{cloud};
    Tree tree(3, adaptor);
    double sum = 0;
    Vectors pull;
    pull.assign(cloud.size(), 0);
    std::vector<std::pair<std::uint32_t, double>> found;
    result = {};
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const std::array<double, 3> at{cloud.x[i], cloud.y[i], cloud.z[i]};
      found.clear();
      tree.radiusSearch(at.data(), kernel.radius * kernel.radius, found,
                        nanoflann::SearchParams(0, 0, false));
      for (const auto& [j, distance2] : found) {
        const double g = std::exp(-kernel.exponent * distance2);
        sum += g - kernel.floor;
        pull.x[i] += g * (points.x[i] - points.x[j]);
        pull.y[i] += g * (points.y[i] - points.y[j]);
        pull.z[i] += g * (points.z[i] - points.z[j]);
      }
      result.tested += found.size();
    }
    benchmark::DoNotOptimize(sum);
    benchmark::DoNotOptimize(pull.x.data());
  }
  result.pairs = (result.tested - cloud.size()) / 2;
  count(state, result, cloud.size());
}

// Side by side: the ratio of a row's time to grid's is what grid saves.
BENCHMARK_CAPTURE(by_search, flann, "flann", false)->Args({100000, 100, 1});
BENCHMARK(by_nanoflann)->Args({100000, 100, 1});
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
BENCHMARK(exponent)->Arg(10000)->Arg(100000)->Arg(1000000)->Iterations(3);

}  // namespace
}  // namespace crisp
