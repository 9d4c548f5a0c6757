// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/live/emulated_scanner.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <vector>

#include "grabbers/emulate/emulator.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

/// What the scanner's process does. What is sent faster than in real time is simulated beforehand.
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
  Emulator emulator(rig, {.speed = trial.speed, .plate_to = rig.plate.address, .faults = faults_of(trial)});
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

}  // namespace

RecordingSettings recording_of(const Trial& trial) {
  RecordingSettings settings;
  settings.scanner.duration = trial.seconds;
  return settings;
}

EmulatedFaults faults_of(const Trial& trial) {
  if (trial.faults == 0) return {};
  return {.dropped = trial.faults,
          .stalled = trial.faults,
          .split = std::min(1.0, 10 * trial.faults),
          .damaged = trial.faults,
          .restarted = trial.faults / 3,
          .lost = trial.faults,
          .skews = {100e-6, -200e-6, 50e-6}};
}

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

ScannerProcess::ScannerProcess(const Trial& trial, const Rig& rig) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw Error(std::string("no pipe to the scanner: ") + std::strerror(errno));
  process_ = fork();
  if (process_ < 0) throw Error(std::string("no process for the scanner: ") + std::strerror(errno));
  if (process_ == 0) be_the_scanner(trial, rig, ends[1]);
  close(ends[1]);
  told_ = ends[0];
}

ScannerProcess::~ScannerProcess() {
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  close(told_);
}

std::optional<Sent> ScannerProcess::await_end() const {
  Sent sent;
  if (read(told_, &sent, sizeof sent) != static_cast<ssize_t>(sizeof sent)) return {};
  return sent;
}

}  // namespace crisp
