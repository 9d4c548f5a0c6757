// SPDX-License-Identifier: BSD-3-Clause
// The whole live path in real time: an emulated scanner in a process of its own, and in this one a pipeline
// that records it and makes points of it. Says what was lost, what it cost, how late the points were, and
// whether the recording gives the same measurements again, byte for byte.
//
//     live_trial [SECONDS [SPEED [FAULTS]]]
//
// SECONDS of the emulated scanner's time (60), SPEED times real time (1), FAULTS: share of the scans that
// each kind of fault befalls (0).
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

#include "grabbers/emulate/emulator.hpp"
#include "grabbers/live/live_source.hpp"
#include "grabbers/simulate/recording.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/app/builtin.hpp"
#include "pipeline/data/cloud.hpp"
#include "pipeline/files/atomic_file.hpp"
#include "pipeline/files/calibration_file.hpp"
#include "pipeline/stage/pipeline_file.hpp"
#include "pipeline/stage/runner.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

struct Trial {
  double seconds = 60;
  double speed = 1;
  double faults = 0;
};

/// What the scanner tells when it has sent everything.
struct Sent {
  std::uint64_t scans = 0, readings = 0;
  EmulatedLedger ledger;
};

Rig rig_with_free_ports() {
  Rig rig = default_rig();
  boost::asio::io_context context;
  const auto loopback = boost::asio::ip::make_address("127.0.0.1");
  std::vector<boost::asio::ip::tcp::acceptor> taken;  // at once, so that they differ
  for (RigLaser& laser : rig.lasers) {
    taken.emplace_back(context, boost::asio::ip::tcp::endpoint(loopback, 0));
    laser.address = {"127.0.0.1", taken.back().local_endpoint().port()};
  }
  const boost::asio::ip::udp::socket plate(context, {loopback, 0});
  rig.plate.address = {"127.0.0.1", plate.local_endpoint().port()};
  return rig;
}

RecordingSettings recording_of(const Trial& trial) {
  RecordingSettings settings;
  settings.scanner.duration = trial.seconds;
  return settings;
}

/// The scanner's process. What is sent faster than in real time is simulated beforehand.
[[noreturn]] void be_the_scanner(const Trial& trial, const Rig& rig, int tell) {
  RecordingSimulator simulator(recording_of(trial), office());
  const auto next = [&]() -> std::optional<HubItem> {
    const auto event = simulator.next();
    if (!event) return {};
    const auto* telegram = std::get_if<LaserTelegram>(&*event);
    if (telegram == nullptr) return std::get<PlateReading>(*event);
    return std::make_shared<const Scan>(to_scan(*telegram));
  };
  std::deque<HubItem> ready;
  if (trial.speed > 1) {
    while (auto item = next()) ready.push_back(std::move(*item));
  }
  Emulator emulator(rig, {.speed = trial.speed,
                          .plate_to = rig.plate.address,
                          .faults = {.dropped = trial.faults,
                                     .stalled = trial.faults,
                                     .split = std::min(1.0, 10 * trial.faults),
                                     .damaged = trial.faults,
                                     .restarted = trial.faults / 3,
                                     .lost = trial.faults}});
  Sent sent;
  while (true) {
    std::optional<HubItem> item;
    if (trial.speed <= 1) {
      item = next();
    } else if (!ready.empty()) {
      item = std::move(ready.front());
      ready.pop_front();
    }
    if (!item) break;
    ++(std::holds_alternative<PlateReading>(*item) ? sent.readings : sent.scans);
    emulator.send(*item, [] { return false; });
  }
  emulator.finish();
  sent.ledger = emulator.ledger();
  if (write(tell, &sent, sizeof sent) != static_cast<ssize_t>(sizeof sent)) std::_Exit(EXIT_FAILURE);
  pause();  // the devices stay where they are; the other process ends this one
  std::_Exit(EXIT_SUCCESS);
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  double total = 0;
  double resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024 * 1024);
}

double monotonic() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// FNV-1a of all measurements of each laser, in their order.
class Fingerprint {
 public:
  void add(const Measurements& scan) {
    ++scans;
    add(scan.range);
    add(scan.mirror_angle);
    add(scan.time);
    add(scan.laser);
    add(scan.remission);
    add(scan.beam);
    add(std::vector<std::int64_t>{scan.epoch_ns});
  }
  bool operator==(const Fingerprint&) const = default;

  std::uint64_t scans = 0;

 private:
  template <class T>
  void add(const std::vector<T>& values) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (std::size_t i = 0; i < values.size() * sizeof(T); ++i)
      hash_ = (hash_ ^ bytes[i]) * 1'099'511'628'211U;
  }
  std::uint64_t hash_ = 14'695'981'039'346'656'037U;
};

/// Watches what flows: how late points are, and what it costs.
class Watch {
 public:
  void given(const std::string& tag, const Item& item) {
    if (const auto scan = item.as<Scan>()) {
      waiting_[scan->laser].push_back(scan->receipt_ns);
      ++scans;
    } else if (item.as<PlateReading>()) {
      ++readings;
    } else if (const auto measurements = item.as<Measurements>()) {
      fingerprint.add(*measurements);
    } else if (const auto cloud = item.as<Cloud>(); cloud && tag == "assemble.deskew") {
      points += cloud->size();
      arrive(*cloud);
    }
    const double now = monotonic();
    if (scans + readings == 0) return;  // what is there before the devices are
    if (begun == 0) {
      begun = now;
      begun_cpu = cpu_seconds();
    }
    if (now - memory_asked_ > 1) {
      memory_asked_ = now;
      memory.push_back(resident_megabytes());
    }
    last_ = now;
  }

  double quantile(double share) {
    if (latencies_.empty()) return 0;
    std::ranges::sort(latencies_);
    return latencies_[static_cast<std::size_t>(share * static_cast<double>(latencies_.size() - 1))];
  }
  double elapsed() const { return last_ - begun; }
  /// The most in each tenth of the time.
  std::string memory_in_tenths() const {
    constexpr std::size_t kTenths = 10;
    std::string text;
    for (std::size_t k = 0; k < kTenths; ++k) {
      const auto first = memory.begin() + static_cast<std::ptrdiff_t>(k * memory.size() / kTenths);
      const auto end = memory.begin() + static_cast<std::ptrdiff_t>((k + 1) * memory.size() / kTenths);
      if (first != end) text += fmt::format("{:.1f} ", *std::max_element(first, end));
    }
    return text + "MiB, the most in each tenth of the time";
  }

  std::uint64_t scans = 0, readings = 0, points = 0;
  Fingerprint fingerprint;
  double begun = 0, begun_cpu = 0;  ///< [s]
  std::vector<double> memory;       ///< [MiB] each second

 private:
  void arrive(const Cloud& cloud) {
    if (cloud.empty()) return;
    auto& queue = waiting_[cloud.front().laser];
    if (queue.empty()) return;
    // Scans that came before their clock was believed wait for that, which is no latency.
    const double late = 1e-9 * static_cast<double>(now_ns() - queue.front());
    queue.pop_front();
    if (monotonic() - begun > 2) latencies_.push_back(late);
  }

  std::map<std::uint16_t, std::deque<std::int64_t>> waiting_;
  std::vector<double> latencies_;
  double memory_asked_ = 0;
  double last_ = 0;
};

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

std::vector<NodeResult> run(std::string_view text, const char* name, const fs::path& folder, const Rig& rig,
                            const RunHooks& hooks) {
  Builtin builtin;
  RunSettings settings;
  settings.registrar = &builtin.registrar();
  PipelineArguments arguments;
  arguments.output = folder;
  auto loaded = load_pipeline(text, name, arguments, settings);
  settings.rig = rig;
  return run_pipeline(loaded.pipeline, settings, hooks);
}

double time_to_stop(const Rig& rig) {
  LiveSource source(rig);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const double begin = monotonic();
  source.close();
  return monotonic() - begin;
}

void print_losses(const std::vector<NodeResult>& results) {
  for (const NodeResult& node : results) {
    for (const auto& [what, n] : node.report.counts) {
      if (n > 0) std::cout << "  " << node.tag << ": " << what << ": " << n << "\n";
    }
    for (const auto& doubt : node.report.doubts) std::cout << "  " << node.tag << ": " << doubt << "\n";
  }
}

/// What was found of the clocks by the times at which this process took the data.
void print_clocks(const std::vector<NodeResult>& results, const RecordingTruth& truth) {
  std::vector<DeviceTruth> devices = truth.lasers;
  devices.push_back(truth.plate);
  const auto clocks = std::ranges::find(results, "clock.online", &NodeResult::tag);
  std::size_t k = 0;
  for (const auto& device : clocks->report.section.at("devices")) {
    std::cout << fmt::format(
        "clock of {}: skew {:+.2f} ppm, in truth {:+.2f} ppm; delays {:.0f} us in the median, "
        "{:.0f} us at 95 %\n",
        device.at("device").get<std::string>(), device.at("skew_ppm").get<double>(),
        1e6 * devices.at(k++).clock.skew, 1e6 * device.at("delay_median").get<double>(),
        1e6 * device.at("delay_95").get<double>());
  }
}

int attempt(const Trial& trial, const fs::path& folder) {
  const Rig rig = rig_with_free_ports();
  const RecordingTruth truth = RecordingSimulator(recording_of(trial), office()).truth();
  write_calibration(folder / "truth.yaml", truth.calibration);
  std::array<int, 2> pipe_ends{};
  if (pipe(pipe_ends.data()) != 0) return EXIT_FAILURE;
  const pid_t scanner = fork();
  if (scanner == 0) be_the_scanner(trial, rig, pipe_ends[1]);

  Watch watch;
  std::atomic<bool> stop = false;
  Sent sent;
  std::thread listener([&] {
    if (read(pipe_ends[0], &sent, sizeof sent) == static_cast<ssize_t>(sizeof sent)) {
      std::this_thread::sleep_for(std::chrono::seconds(1));  // for what is on its way
    }
    stop = true;
  });
  RunHooks hooks{.stop = &stop};
  hooks.given = [&](const std::string& tag, const Item& item) { watch.given(tag, item); };
  const auto results = run(kLive, "live", folder, rig, hooks);
  const double cost = cpu_seconds() - watch.begun_cpu;
  listener.join();
  const double stopping = time_to_stop(rig);
  kill(scanner, SIGKILL);
  waitpid(scanner, nullptr, 0);

  Watch offline;
  RunHooks again;
  again.given = [&](const std::string& tag, const Item& item) { offline.given(tag, item); };
  run(kOffline, "offline", folder, rig, again);
  const bool same = offline.fingerprint == watch.fingerprint;

  std::cout << "scanner: " << sent.scans << " scans, " << sent.readings << " readings of the plate, "
            << sent.ledger.faults() << " faults (dropped " << sent.ledger.dropped << ", damaged "
            << sent.ledger.damaged + sent.ledger.readings_damaged << ", stalled " << sent.ledger.stalled
            << ", restarted " << sent.ledger.restarted << ", datagrams lost " << sent.ledger.readings_lost
            << ", unheard " << sent.ledger.unheard << ", missed " << sent.ledger.missed << ")\n"
            << "received: " << watch.scans << " scans, " << watch.readings << " readings, " << watch.points
            << " points in " << watch.elapsed() << " s\n"
            << "CPU: " << 100 * cost / watch.elapsed() << " % of one core\n"
            << "latency from a telegram's arrival to its points: median " << 1e3 * watch.quantile(0.5)
            << " ms, 99 % " << 1e3 * watch.quantile(0.99) << " ms, most " << 1e3 * watch.quantile(1)
            << " ms\n"
            << "resident memory: " << watch.memory_in_tenths() << "\n"
            << "stopped within " << 1e3 * stopping << " ms\n"
            << "measurements from the recording: " << offline.fingerprint.scans << " scans, "
            << (same ? "byte for byte the same" : "NOT THE SAME") << "\n"
            << "counted:\n";
  print_losses(results);
  if (trial.speed == 1) print_clocks(results, truth);
  return same ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace crisp

int main(int count, char** words) {
  crisp::Trial trial;
  if (count > 1) trial.seconds = std::atof(words[1]);
  if (count > 2) trial.speed = std::atof(words[2]);
  if (count > 3) trial.faults = std::atof(words[3]);
  const auto folder =
      std::filesystem::temp_directory_path() / ("crisp-live-trial-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  int status = EXIT_FAILURE;
  try {
    status = crisp::attempt(trial, folder);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
  }
  std::filesystem::remove_all(folder);
  return status;
}
