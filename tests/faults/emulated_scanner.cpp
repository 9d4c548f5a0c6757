// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/emulated_scanner.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include "tests/faults/program_run.hpp"

namespace crisp::test {
namespace {

sockaddr_in at_loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

std::uint16_t free_port(int type) {
  const int probe = socket(AF_INET, type, 0);
  sockaddr_in address = at_loopback(0);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  const bool is_bound = bind(probe, generic, size) == 0 && getsockname(probe, generic, &size) == 0;
  close(probe);
  if (!is_bound) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

bool answers(std::uint16_t port) {
  const int probe = socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = at_loopback(port);
  const bool is_there = connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(probe);
  return is_there;
}

constexpr const char* kRig = R"(crisp: 1
lasers:
  laser1: {{address: 127.0.0.1, port: {}, mount: 45deg, nominal: {{lambda: 0deg, tau: 20cm}}}}
plate: {{address: 127.0.0.1, port: {}, counts_per_revolution: 16384}}
)";

}  // namespace

EmulatedScanner::EmulatedScanner(const std::filesystem::path& rig) {
  const std::uint16_t laser = free_port(SOCK_STREAM);
  const std::uint16_t plate = free_port(SOCK_DGRAM);
  put_bytes(rig, fmt::format(kRig, laser, plate));
  process_ = start_program({"emulate", "--rig", rig.string(), "-o", (own_ / "out").string(), "--duration",
                            "36000s", "--quiet", "--plate-to", fmt::format("127.0.0.1:{}", plate)},
                           own_ / "messages");
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    if (answers(laser)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  throw std::runtime_error("crisp emulate: " + bytes_of(own_ / "messages"));
}

EmulatedScanner::~EmulatedScanner() {
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

}  // namespace crisp::test
