// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <filesystem>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/paper.hpp"
#include "grabbers/simulate/recorded_capture.hpp"
#include "grabbers/simulate/scenes.hpp"

namespace crisp {
namespace {

using namespace crisp::simulate;

void simulate_scene(benchmark::State& state, const std::string& name) {
  const Scene scene = built_in_scene(name);
  std::size_t beams = 0;
  for (auto _ : state) {
    const auto simulated = simulate_measurements({}, scene);
    beams += simulated.beams.size() + simulated.no_echo;
  }
  state.counters["beams/s"] = benchmark::Counter(static_cast<double>(beams), benchmark::Counter::kIsRate);
}

void write_capture(benchmark::State& state) {
  const auto file = std::filesystem::temp_directory_path() / "crisp_simulate_bench.pcap";
  const RecordingSettings settings;
  for (auto _ : state) {
    RecordingSimulator simulator(settings, office());
    RecordedCapture capture(file, settings, simulator.truth());
    while (const auto event = simulator.next()) capture.write(*event);
    capture.close();
  }
  std::filesystem::remove(file);
}

void simulate_paper(benchmark::State& state) {
  const Scene room = paper_room();
  std::uint64_t seed = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(simulate_measurements(paper_scanner(++seed), room).beams.size());
}

void measure_distance(benchmark::State& state) {
  const RayCaster office_surfaces(office());
  double x = 0;
  for (auto _ : state) {
    x = x > 3 ? -3 : x + 0.01;
    benchmark::DoNotOptimize(office_surfaces.distance({x, 0.3 * x, 0.5}));
  }
}

BENCHMARK_CAPTURE(simulate_scene, office_10s, std::string("office"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(simulate_scene, hall_10s, std::string("hall"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(simulate_scene, street_10s, std::string("street"))->Unit(benchmark::kMillisecond);
BENCHMARK(write_capture)->Unit(benchmark::kMillisecond);
BENCHMARK(simulate_paper)->Unit(benchmark::kMillisecond);
BENCHMARK(measure_distance);

}  // namespace
}  // namespace crisp
