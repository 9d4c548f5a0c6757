// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <variant>
#include <vector>

#include <crisp/clock_aligner.hpp>

#include "pipeline/clocks/lower_hull.hpp"
#include "tests/plugins/clock/simulated_scanner.hpp"

namespace crisp {
namespace {

using namespace crisp::clocks;
using test::exponential_delays;
using test::mean_device_time;
using test::simulated_stamps;
using test::SimulatedLaser;
using test::SimulatedPlate;

using Event = std::variant<std::shared_ptr<const Scan>, PlateReading>;

/// Three lasers at 50 Hz with 541 beams and a plate at 500 Hz, in the order of receipt.
std::vector<Event> events(double duration) {
  std::multimap<std::int64_t, Event> arrivals;
  for (std::uint16_t i = 0; i < 3; ++i) {
    for (auto& turn : SimulatedLaser{}.turns(1, i, duration)) {
      const auto receipt = turn.scan.receipt_ns;
      arrivals.emplace(receipt, std::make_shared<const Scan>(std::move(turn.scan)));
    }
  }
  for (const auto& reading : SimulatedPlate{}.readings(1, duration))
    arrivals.emplace(reading.receipt_ns, reading);
  std::vector<Event> all;
  for (auto& arrival : arrivals) all.push_back(std::move(arrival.second));
  return all;
}

void align(benchmark::State& state, const AlignmentSettings& settings) {
  const double duration = 200;
  const auto all = events(duration);
  std::size_t beams = 0;
  for (auto _ : state) {
    ClockAligner aligner(
        default_rig(), settings,
        {.trajectory = [](const PlateTrajectory& plate) { benchmark::DoNotOptimize(plate.size()); },
         .measurements = [&](const std::shared_ptr<const Measurements>& scan) { beams += scan->size(); }});
    for (const auto& event : all) std::visit([&](const auto& received) { aligner.add(received); }, event);
    benchmark::DoNotOptimize(aligner.finish());
  }
  state.counters["beams/s"] = benchmark::Counter(static_cast<double>(beams), benchmark::Counter::kIsRate);
  state.counters["x real time"] =
      benchmark::Counter(duration * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void hull_online(benchmark::State& state) {
  const auto stamps = simulated_stamps(1, 600, 50, 1e-4, exponential_delays(1e-4));
  for (auto _ : state) {
    HullClock clock;
    for (const auto& stamp : stamps) clock.add(stamp);
    benchmark::DoNotOptimize(clock.line());
  }
  state.counters["stamps/s"] = benchmark::Counter(static_cast<double>(stamps.size() * state.iterations()),
                                                  benchmark::Counter::kIsRate);
}

void line_of_ten_minutes(benchmark::State& state, ClockLine (*find)(std::span<const Stamp>, double)) {
  const auto stamps = simulated_stamps(1, 600, 50, 1e-4, exponential_delays(1e-4));
  const double mean = mean_device_time(stamps);
  for (auto _ : state) benchmark::DoNotOptimize(find(stamps, mean));
  state.counters["stamps/s"] = benchmark::Counter(static_cast<double>(stamps.size() * state.iterations()),
                                                  benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(align, convex_hull, AlignmentSettings{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(align, receipt, AlignmentSettings{.source = TimeSource::receipt})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(hull_online);
BENCHMARK_CAPTURE(line_of_ten_minutes, convex_hull, line_by_convex_hull);

}  // namespace
}  // namespace crisp
