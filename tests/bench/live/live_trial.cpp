// SPDX-License-Identifier: BSD-3-Clause
// The whole live path in real time: an emulated scanner in a process of its own, and in this one the pipeline
// of configs/live.yaml, and a recording. Reports losses, cost, the points' delay and their distance from the
// scene's surfaces, and whether the recording reproduces the measurements byte for byte.
//
//     live_trial [SECONDS [SPEED [FAULTS [SCANNER]]]]
//
// SCANNER: the program whose scanner is emulated, if it is another live_trial than this. With sanitizers the
// simulator is too slow for real time, so that one without them is needed.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <thread>

#include <crisp/calibration_file.hpp>
#include <crisp/effect_catalogue.hpp>
#include <crisp/pipeline.hpp>
#include <crisp/runner.hpp>

#include "grabbers/capture/register.hpp"
#include "grabbers/live/live_source.hpp"
#include "grabbers/live/live_stage.hpp"
#include "grabbers/record/record_stage.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "plugins/assemble/register.hpp"
#include "plugins/calibrate/register.hpp"
#include "plugins/calibrate/watch/register.hpp"
#include "plugins/clock/register.hpp"
#include "plugins/write/register.hpp"
#include "tests/bench/live/emulated_scanner.hpp"
#include "tests/bench/live/watch.hpp"
#include "tests/end_to_end/scene_distance.hpp"

namespace crisp {
namespace {

using namespace crisp::assemble;
using namespace crisp::calibrate;
using namespace crisp::capture;
using namespace crisp::clock;
using namespace crisp::emulate;
using namespace crisp::live;
using namespace crisp::record;
using namespace crisp::simulate;
using namespace crisp::write;
namespace fs = std::filesystem;

constexpr std::string_view kLive = R"(crisp: 1
pipeline:
  - stage: calibrate.load
    with: {file: "${output}/truth.yaml"}
  - stage: grabber.live
  - stage: write.capture
    with: {file: "${output}/hub.pcap"}
  - stage: clock.online
    with: {lag_margin: 2ms}
  - stage: calibrate.watch
    with: {recalibrate: at_start}
  - stage: assemble.deskew
  - stage: assemble.revolutions
  - stage: write.clouds
    with: {file: "${output}/cloud.pcd", keep: 3}
)";
constexpr std::string_view kOffline = R"(crisp: 1
pipeline:
  - stage: calibrate.load
    with: {file: "${output}/truth.yaml"}
  - stage: grabber.capture
    with: {file: "${output}/hub.pcap"}
  - stage: clock.online
    with: {lag_margin: 2ms}
  - stage: assemble.deskew
)";

/// The stages of the two pipelines: the fewer, the sooner it is built with sanitizers.
class Stages {
 public:
  Stages() {
    registrar_.attach(terms_);
    register_built_in(terms_);
    register_capture(registrar_);
    register_live(registrar_);
    register_record(registrar_);
    register_clock(registrar_);
    register_assemble(registrar_);
    register_calibrate(registrar_);
    register_watch(registrar_);
    register_write(registrar_);
  }
  const Registrar& registrar() const { return registrar_; }

 private:
  TermRegistry terms_;
  Registrar registrar_;
};

std::vector<NodeResult> run(std::string_view text, const char* name, const fs::path& folder, const Rig& rig,
                            Watch& watch, const std::atomic<bool>* stop = nullptr) {
  const Stages stages;
  RunSettings settings;
  settings.registrar = &stages.registrar();
  PipelineArguments arguments;
  arguments.output = folder;
  auto loaded = load_pipeline(text, name, arguments, settings);
  settings.rig = rig;
  RunHooks hooks{.stop = stop};
  hooks.given = [&](const std::string& tag, const Item& item) { watch.given(tag, item); };
  return run_pipeline(loaded.pipeline, settings, hooks);
}

double time_to_stop(const Rig& rig) {
  LiveSource source(rig);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const double begin = monotonic();
  source.close();
  return monotonic() - begin;
}

std::string milliseconds(const std::vector<double>& seconds) {
  const Sorted sorted(seconds);
  return fmt::format("median {:.2f} ms, 99 % {:.2f} ms, 99.9 % {:.1f} ms, most {:.0f} ms",
                     1e3 * sorted.quantile(0.5), 1e3 * sorted.quantile(0.99), 1e3 * sorted.quantile(0.999),
                     1e3 * sorted.quantile(1));
}

void print_sent(const Sent& sent) {
  const EmulatedLedger& ledger = sent.ledger;
  std::cout << fmt::format(
      "scanner: {} scans, {} encoder readings, {} faults (dropped {}, damaged {}, stalled {}, restarted {}, datagrams lost {}); unheard {}, missed {}\n",
      sent.scans, sent.readings, ledger.faults(), ledger.dropped, ledger.damaged + ledger.readings_damaged,
      ledger.stalled, ledger.restarted, ledger.readings_lost, ledger.unheard, ledger.missed);
}

void print_counts(const std::vector<NodeResult>& results) {
  std::cout << "counted:\n";
  for (const NodeResult& node : results) {
    for (const auto& [what, n] : node.report.counts) {
      if (n > 0) std::cout << "  " << node.tag << ": " << what << ": " << n << "\n";
    }
    for (const auto& caveat : node.report.caveats) std::cout << "  " << node.tag << ": " << caveat << "\n";
  }
}

/// What was found of the clocks by the times at which this process took the data.
void print_clocks(const std::vector<NodeResult>& results, const RecordingTruth& truth,
                  const EmulatedFaults& faults) {
  std::vector<DeviceTruth> devices = truth.lasers;
  devices.push_back(truth.plate);
  const auto clocks = std::ranges::find(results, "clock.online", &NodeResult::tag);
  std::size_t k = 0;
  for (const auto& device : clocks->report.section.at("devices")) {
    // Skews are by how much the hub's seconds are more than the device's.
    const double faster = k < faults.skews.size() ? faults.skews[k] : 0;
    std::cout << fmt::format(
        "clock of {}: skew {:+.2f} ppm, in truth {:+.2f} ppm; delays {:.0f} us in the median, {:.0f} us at 95 %\n",
        device.at("device").get<std::string>(), device.at("skew_ppm").get<double>(),
        1e6 * (devices.at(k).clock.skew - faster), 1e6 * device.at("delay_median").get<double>(),
        1e6 * device.at("delay_95").get<double>());
    ++k;
  }
}

int attempt(const Trial& trial, const std::string& scanner_program, const fs::path& folder) {
  const Rig rig = rig_with_free_ports();
  const RecordingTruth truth = RecordingSimulator(recording_of(trial), office()).truth();
  write_calibration(folder / "truth.yaml", truth.calibration);
  const ScannerProcess scanner(trial, rig, scanner_program);

  Watch live;
  Sleeper sleeper;
  std::optional<Sent> sent;
  std::atomic<bool> stop = false;
  std::vector<NodeResult> results;
  double cpu = 0;
  {
    const std::jthread listener([&] {
      sent = scanner.await_end();
      std::this_thread::sleep_for(std::chrono::seconds(1));  // for what is on its way
      stop = true;
    });
    results = run(kLive, "live", folder, rig, live, &stop);
    cpu = live.cpu();
  }
  const auto slept = sleeper.late();
  if (!sent) throw Error("the scanner's process failed");
  print_sent(*sent);
  std::cout << fmt::format("received: {} scans, {} readings, {} points in {:.1f} s\n", live.scans,
                           live.readings, live.points, live.elapsed());
  std::cout << fmt::format("CPU: {:.2f} % of one core\n", 100 * cpu / live.elapsed());
  if (trial.faults == 0) {  // otherwise some received scans have no points, and cannot be matched
    std::cout << "latency from a telegram's arrival to its points: " << milliseconds(live.latencies())
              << "\n";
  }
  std::cout << "a thread that only sleeps wakes up late by: " << milliseconds(slept) << "\n";
  std::cout << "resident memory: " << live.memory_in_tenths() << "\n";
  std::cout << fmt::format("stopped within {:.1f} ms\n", 1e3 * time_to_stop(rig));
  if (trial.speed == 1) {
    const auto distance = test::distance_to(office(), live.sample, 1);
    std::cout << fmt::format("{} of the points are {:.2f} mm from the scene (root of the mean square)\n",
                             live.sample.size(), 1e3 * distance.as_it_is);
  }

  Watch offline;
  run(kOffline, "offline", folder, rig, offline);
  const bool same = offline.fingerprint == live.fingerprint;
  std::cout << fmt::format("measurements from the recording: {} scans, {}\n", offline.fingerprint.scans,
                           same ? "byte for byte the same" : "NOT THE SAME");
  print_counts(results);
  if (trial.speed == 1) print_clocks(results, truth, faults_of(trial));
  return same ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace crisp

int main(int count, char** arguments) {
  const std::vector<std::string> words(arguments + 1, arguments + count);
  const auto number = [&](std::size_t i, double otherwise) {
    return i < words.size() ? std::stod(words[i]) : otherwise;
  };
  const auto folder =
      std::filesystem::temp_directory_path() / ("crisp-live-trial-" + std::to_string(getpid()));
  int status = EXIT_FAILURE;
  try {
    if (!words.empty() && words[0] == crisp::kBeTheScanner) crisp::be_the_scanner(words);
    std::filesystem::create_directories(folder);
    status = crisp::attempt({number(0, 60), number(1, 1), number(2, 0)},
                            words.size() > 3 ? words[3] : "/proc/self/exe", folder);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
  }
  std::filesystem::remove_all(folder);
  return status;
}
