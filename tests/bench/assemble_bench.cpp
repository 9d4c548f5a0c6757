// SPDX-License-Identifier: BSD-3-Clause
// Rate at which measurements become points, on one core: scan by scan, as a recording streams through the
// stage; compared with a plain copy of as many bytes.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <ctime>

#include <crisp/cloud.hpp>
#include <crisp/registrar.hpp>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "plugins/assemble/deskew_stage.hpp"

namespace crisp {
namespace {

using namespace crisp::assemble;
using namespace crisp::simulate;

constexpr std::size_t kBeams = 541;  // in a scan

/// Ten seconds in the office, a scan an item as clock stages give them.
struct Recording {
  std::vector<Item> scans;
  Item plate;
  Item calibration;

  Recording()
      : plate(Item::of<PlateTrajectory>(nullptr)),
        calibration(
            Item::of<Calibration>(std::make_shared<const Calibration>(nominal_calibration(default_rig())))) {
    const auto simulated = simulate_measurements({.truth = nominal_calibration(default_rig())}, office());
    plate = Item::of<PlateTrajectory>(std::make_shared<const PlateTrajectory>(simulated.plate));
    const Measurements& all = simulated.beams;
    for (std::size_t begin = 0; begin < all.size(); begin += kBeams) {
      const std::size_t end = std::min(begin + kBeams, all.size());
      const auto part = [&](const auto& values) {
        return std::remove_cvref_t<decltype(values)>(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                                     values.begin() + static_cast<std::ptrdiff_t>(end));
      };
      scans.push_back(Item::of<Measurements>(std::make_shared<const Measurements>(
          Measurements{all.epoch_ns, part(all.range), part(all.mirror_angle), part(all.time), part(all.laser),
                       part(all.remission), part(all.beam)})));
    }
  }
};

constexpr std::size_t kRead = 24;  // bytes of a measurement
constexpr std::size_t kWritten = sizeof(Point);

std::size_t beams_of(const Recording& recording) {
  std::size_t n = 0;
  for (const auto& scan : recording.scans) n += scan.as<Measurements>()->size();
  return n;
}

void set_rates(benchmark::State& state, std::size_t beams) {
  const double all = static_cast<double>(beams) * static_cast<double>(state.iterations());
  state.counters["points/s"] = benchmark::Counter(all, benchmark::Counter::kIsRate);
  state.counters["B/s"] =
      benchmark::Counter(all * (kRead + kWritten), benchmark::Counter::kIsRate, benchmark::Counter::kIs1024);
}

/// Reads and writes half of the bytes each that so many beams and points have, in one go.
class Copy {
 public:
  explicit Copy(std::size_t beams) : from_(beams * (kRead + kWritten) / 2, 'x'), to_(from_.size()) {}

  void run() {
    std::memcpy(to_.data(), from_.data(), from_.size());
    benchmark::DoNotOptimize(to_.data());
    benchmark::ClobberMemory();
  }

 private:
  std::vector<char> from_;
  std::vector<char> to_;
};

void copy_as_many_bytes(benchmark::State& state) {
  const std::size_t beams = beams_of(Recording());
  Copy copy(beams);
  for (auto _ : state) copy.run();
  set_rates(state, beams);
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void deskew_scans(benchmark::State& state) {
  const Recording recording;
  TermRegistry terms;
  Registrar registrar;
  registrar.attach(terms);
  const RunSettings run{.registrar = &registrar};
  StageReport report;
  Context context(run, report);
  Outputs out([](const Item& item) { benchmark::DoNotOptimize(item.as<Cloud>()->points.data()); });
  DeskewStage stage;
  Copy copy(beams_of(recording));
  double copying = 0;
  double deskewing = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const double before = cpu_seconds();
    copy.run();
    copying += cpu_seconds() - before;
    state.ResumeTiming();
    const double start = cpu_seconds();
    for (const auto& scan : recording.scans) {
      const std::array items = {scan, recording.plate, recording.calibration};
      stage.process(Inputs(items), out, context);
    }
    deskewing += cpu_seconds() - start;
  }
  state.counters["of_copy"] = copying / deskewing;
  set_rates(state, beams_of(recording));
}

BENCHMARK(copy_as_many_bytes)->Unit(benchmark::kMillisecond);
BENCHMARK(deskew_scans)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace crisp
