// SPDX-License-Identifier: BSD-3-Clause
// RQE with its gradient compared with competing implementations, in one process, and its complexity: in the
// number of points, of lasers and of threads, and in σ. Prints the ratios and exponents themselves; times are
// CPU times of one thread, the least of a few rounds, unless stated otherwise.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include <crisp/neighbour_search.hpp>
#include <crisp/rqe.hpp>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "plugins/calibrate/cloud_objective.hpp"
#include "tests/bench/rivals.hpp"
#include "tests/bench/walls.hpp"

namespace crisp::bench {
namespace {

using namespace crisp::calibrate;
using namespace crisp::estimate;
using namespace crisp::simulate;

using Work = std::function<void()>;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// [s] that work takes, at the least of some rounds.
double least(const Work& work, int rounds, double (*clock)() = cpu_seconds) {
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    const double start = clock();
    work();
    best = std::min(best, clock() - start);
  }
  return best;
}

std::unique_ptr<Search> make_search(const std::string& name) {
  SearchRegistry registry;
  register_built_in(registry);
  return registry.make(name);
}

/// Each coordinate moved by up to so much [m].
Vectors shaken(Vectors points, double by) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> move(-by, by);
  for (std::vector<double>* axis : {&points.x, &points.y, &points.z}) {
    for (double& at : *axis) at += move(random);
  }
  return points;
}

double entropy(const TruncatedGaussian& kernel, double sum, std::size_t n) {
  return -std::log(kernel.peak * sum / (static_cast<double>(n) * static_cast<double>(n)));
}

void next_to_rivals() {
  constexpr std::size_t kPoints = 100000;
  constexpr double kSigma = 0.02;
  const TruncatedGaussian kernel(kSigma, 7);
  const RqeSettings settings{.sigma = kSigma, .error_bound = false};
  const Vectors cloud = test::walls(kPoints, 100, kSigma);
  auto again = make_search("grid");
  Rqe found;
  const double fresh = least([&] { found = rqe(cloud.view(), {}, settings); }, 10);
  const double pairs = 2 * static_cast<double>(found.pairs) + kPoints;
  fmt::print("{} points on walls, {:.0f} neighbours each, cut at 7 sigma, value and gradient\n", kPoints,
             pairs / kPoints);
  fmt::print("  {:34} {:>9} {:>12} {:>9} {:>10}\n", "", "ms", "tested/s", "x grid", "RQE");
  const auto row = [&](const char* name, double seconds, double tested, double value) {
    fmt::print("  {:34} {:9.1f} {:9.0f} M {:9.1f} {:10.6f}\n", name, 1e3 * seconds, 1e-6 * tested / seconds,
               seconds / fresh, value);
  };
  row("grid, from scratch", fresh, static_cast<double>(found.tested), found.value);
  // Between two steps of a search: half a millimetre along each axis, there and back. The first round sorts.
  const std::array<Vectors, 2> moved{cloud, shaken(cloud, 0.5e-3)};
  int step = 0;
  const double second = least([&] { found = rqe(moved[step++ % 2].view(), {}, settings, *again); }, 10);
  row("grid, points moved a little", second, static_cast<double>(found.tested), found.value);
  const auto competitor = [&](const char* name, const std::function<PairSums()>& sums, double tested,
                              int rounds) {
    PairSums result;
    const double seconds = least([&] { result = sums(); }, rounds);
    row(name, seconds, tested, entropy(kernel, result.kernel, kPoints));
  };
  auto flann = make_search("flann");
  const double by_flann = least([&] { found = rqe(cloud.view(), {}, settings, *flann); }, 2);
  row("FLANN's radius search, std::exp", by_flann, static_cast<double>(found.tested), found.value);
  competitor(
      "nanoflann's, std::exp", [&] { return by_nanoflann(cloud, kernel); }, pairs, 2);
  competitor(
      "PCL's KdTreeFLANN, std::exp", [&] { return by_pcl(cloud, kernel); }, pairs, 2);
  const double every = static_cast<double>(kPoints) * kPoints;
  competitor(
      "brute force, by vectors", [&] { return by_brute_force(cloud, kernel); }, every, 1);
}

/// Ends a line with the power of `by` by which the seconds grew, unless it is the first.
void print_exponent(double seconds, double before, double by) {
  if (before > 0) fmt::print("   exponent {:.2f}", std::log(seconds / before) / std::log(by));
  fmt::print("\n");
}

void against_points() {
  fmt::print("\nagainst points, at the same density (100 neighbours)\n");
  double before = 0;
  for (const std::size_t n : {10000U, 100000U, 1000000U, 10000000U}) {
    const Vectors cloud = test::walls(n, 100, 0.02);
    const double seconds =
        least([&] { rqe(cloud.view(), {}, {.sigma = 0.02, .error_bound = false}); }, n < 1000000 ? 20 : 2);
    fmt::print("  {:9} points {:10.2f} ms", n, 1e3 * seconds);
    print_exponent(seconds, before, 10);
    before = seconds;
  }
}

void against_sigma() {
  fmt::print("\nagainst sigma, 100000 points in a corner of 6 m\n");
  const Vectors cloud = test::room_corner(100000, 6, 0.01, 1);
  for (const double sigma : {0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.4, 0.6}) {
    const double seconds = least([&] { rqe(cloud.view(), {}, {.sigma = sigma, .error_bound = false}); }, 5);
    fmt::print("  {:4.0f} cm {:10.1f} ms\n", 100 * sigma, 1e3 * seconds);
  }
}

/// A plate with so many lasers at even azimuths.
Rig rig_of(std::size_t lasers) {
  Rig rig = default_rig();
  const RigLaser first = rig.lasers.front();
  rig.lasers.assign(lasers, first);
  for (std::size_t i = 0; i < lasers; ++i) {
    rig.lasers[i].nominal.name = rig.lasers[i].name = fmt::format("laser{}", i + 1);
    rig.lasers[i].nominal.lambda.value =
        2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(lasers);
  }
  return rig;
}

void against_lasers() {
  fmt::print(
      "\nagainst lasers: a calibration's step (RQE and its gradient by all parameters), 60000 beams in all\n");
  MeasureRegistry measures;
  register_built_in(measures);
  SearchRegistry searches;
  register_built_in(searches);
  double before = 0;
  for (const std::size_t lasers : {1U, 2U, 4U, 8U}) {
    const Rig rig = rig_of(lasers);
    const auto simulated = simulate_measurements({.rig = rig, .truth = nominal_calibration(rig)}, office());
    const Sample sample = thin_evenly({.beams = simulated.beams, .plate = &simulated.plate}, 60000, 1);
    const SensorModel model(simulated.truth);
    const auto free = free_parameters(model, sample.beams, {}).free;
    auto measure = measures.make("rqe", {}, searches);
    const double seconds = least([&] { model_quality(model, sample, free, *measure, 0.05); }, 10);
    fmt::print("  {} lasers, {:2} parameters {:8.1f} ms", lasers, free.size(), 1e3 * seconds);
    print_exponent(seconds, before, 2);
    before = seconds;
  }
}

void against_threads() {
  const Vectors cloud = test::walls(1000000, 100, 0.02);
  double load[1] = {0};
  if (getloadavg(load, 1) < 1) load[0] = std::nan("");
  fmt::print("\nagainst threads, 1000000 points, wall time (load of the machine: {:.1f})\n", load[0]);
  struct Took {
    double wall = 0, cpu = 0;
  };
  Took one;
  for (const std::size_t threads : {1U, 2U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    auto search = make_search("grid");
    const auto work = [&] { rqe(cloud.view(), {}, {.sigma = 0.02, .error_bound = false}, *search); };
    const Took took{.wall = least(work, 12, wall_seconds), .cpu = least(work, 12, cpu_seconds)};
    if (threads == 1) one = took;
    fmt::print("  {} threads {:8.1f} ms, x{:.2f}; {:8.1f} ms of CPU time, which is x{:.2f} on free cores\n",
               threads, 1e3 * took.wall, one.wall / took.wall, 1e3 * took.cpu,
               static_cast<double>(threads) * one.cpu / took.cpu);
  }
}

}  // namespace
}  // namespace crisp::bench

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // each line as soon as it is known
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    crisp::bench::next_to_rivals();
    crisp::bench::against_points();
    crisp::bench::against_sigma();
    crisp::bench::against_lasers();
  }
  crisp::bench::against_threads();
}
