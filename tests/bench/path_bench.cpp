// SPDX-License-Identifier: BSD-3-Clause
// How fast a capture becomes points: reading, clocks and assembly, as a pipeline runs them, in wall time.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>

#include <crisp/builtin.hpp>
#include <crisp/pipeline.hpp>
#include <crisp/runner.hpp>

namespace crisp {
namespace {

constexpr double kSeconds = 300;       // of the recording
constexpr double kPerSecond = 81'150;  // measurements in real time: three lasers, 50 scans of 541 beams

constexpr std::string_view kSimulate = R"(crisp: 1
pipeline:
  - stage: grabber.simulate
    with: {duration: 300s, capture: "${output}/hub.pcap", truth: "${output}/truth.yaml"}
)";
constexpr std::string_view kAssemble = R"(crisp: 1
pipeline:
  - stage: calibrate.load
    with: {file: "${output}/truth.yaml"}
  - stage: grabber.capture
    with: {file: "${output}/hub.pcap"}
  - stage: clock.convex_hull
  - stage: assemble.deskew
)";

std::vector<NodeResult> run(std::string_view text, const std::filesystem::path& folder, unsigned threads) {
  Builtin builtin;
  RunSettings settings{.threads = threads, .registrar = &builtin.registrar()};
  auto loaded = load_pipeline(text, "pipeline.yaml", {.output = folder}, settings);
  return run_pipeline(loaded.pipeline, settings);
}

/// Where the recording lies, as long as this program runs.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / "crisp-path-bench") {
    std::filesystem::create_directories(path_);
    run(kSimulate, path_, 2);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void capture_to_points(benchmark::State& state) {
  static const Folder folder;
  double points = 0;
  for (auto _ : state) {
    const auto results = run(kAssemble, folder.path(), static_cast<unsigned>(state.range(0)));
    points += results.back().report.section["points"].get<double>();
  }
  state.counters["points/s"] = benchmark::Counter(points, benchmark::Counter::kIsRate);
  state.counters["x real time"] = benchmark::Counter(points / kPerSecond, benchmark::Counter::kIsRate);
  state.counters["recording/s"] = kSeconds;
}

BENCHMARK(capture_to_points)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace crisp
