// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/live/emulated_scanner.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
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

#include <crisp/error.hpp>

#include "grabbers/emulate/emulator.hpp"
#include "grabbers/simulate/scenes.hpp"

namespace crisp {
namespace {

using namespace crisp::emulate;
using namespace crisp::simulate;

/// Data sent faster than in real time are simulated beforehand.
[[noreturn]] void send_all(const Trial& trial, const Rig& rig, int report) {
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
  if (write(report, &sent, sizeof sent) != static_cast<ssize_t>(sizeof sent)) std::_Exit(EXIT_FAILURE);
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

void be_the_scanner(const std::vector<std::string>& words) {
  Rig rig = default_rig();
  for (std::size_t i = 0; i < rig.lasers.size(); ++i) {
    rig.lasers[i].address = {"127.0.0.1", static_cast<std::uint16_t>(std::stoul(words.at(5 + i)))};
  }
  rig.plate.address = {"127.0.0.1", static_cast<std::uint16_t>(std::stoul(words.back()))};
  send_all({std::stod(words.at(2)), std::stod(words.at(3)), std::stod(words.at(4))}, rig,
           std::stoi(words.at(1)));
}

ScannerProcess::ScannerProcess(const Trial& trial, const Rig& rig, const std::string& program) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw Error(std::string("no pipe to the scanner: ") + std::strerror(errno));
  std::vector<std::string> words{program, kBeTheScanner, std::to_string(ends[1])};
  for (const double number : {trial.seconds, trial.speed, trial.faults})
    words.push_back(fmt::format("{}", number));
  for (const auto& laser : rig.lasers) words.push_back(std::to_string(laser.address.port));
  words.push_back(std::to_string(rig.plate.address.port));
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  process_ = fork();
  if (process_ < 0) throw Error(std::string("no process for the scanner: ") + std::strerror(errno));
  if (process_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody is left behind
    execv(program.c_str(), arguments.data());
    std::_Exit(EXIT_FAILURE);
  }
  close(ends[1]);
  reported_ = ends[0];
}

ScannerProcess::~ScannerProcess() {
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  close(reported_);
}

std::optional<Sent> ScannerProcess::await_end() const {
  Sent sent;
  if (read(reported_, &sent, sizeof sent) != static_cast<ssize_t>(sizeof sent)) return {};
  return sent;
}

}  // namespace crisp
