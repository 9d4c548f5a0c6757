// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/process_identity.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>

namespace crisp::files {
namespace {

std::string first_line(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

/// Containers on one machine may have one name and one process number each.
std::string machine_of_this_process() {
  std::error_code unknown;
  const std::string numbers = std::filesystem::read_symlink("/proc/self/ns/pid", unknown).string();
  return first_line("/proc/sys/kernel/random/boot_id") + " " + numbers;
}

/// The kernel's state of a process, by /proc/N/stat.
struct ProcessState {
  char state = '?';  ///< 'Z': ended, and its parent has not collected its status yet
  std::uint64_t start = 0;
};

std::optional<ProcessState> state_of(pid_t number) {
  std::string line = first_line(fmt::format("/proc/{}/stat", number));
  // The second field is the program's name in brackets, which may hold anything.
  const std::size_t name_end = line.rfind(')');
  if (name_end == std::string::npos) return std::nullopt;
  constexpr int kFieldsBetween = 18;  // from the state, the third, to the start, the 22nd
  std::istringstream fields(line.substr(name_end + 1));
  ProcessState process;
  fields >> process.state;
  std::string skipped;
  for (int i = 0; i < kFieldsBetween; ++i) fields >> skipped;
  fields >> process.start;
  return fields ? std::optional(process) : std::nullopt;
}

std::string machine_in_name(const ProcessIdentity& process) {
  return fmt::format("{:016x}", std::hash<std::string>()(process.machine));
}

bool has_process(pid_t number) { return kill(number, 0) == 0 || errno == EPERM; }

}  // namespace

ProcessIdentity this_process() {
  const pid_t number = getpid();
  const auto state = state_of(number);
  return {host_name(), machine_of_this_process(), number, state ? state->start : 0};
}

std::string command_of_this_process() {
  std::ifstream stream("/proc/self/cmdline", std::ios::binary);
  std::string command(std::istreambuf_iterator<char>(stream), {});
  while (command.ends_with('\0')) command.pop_back();
  std::ranges::replace(command, '\0', ' ');
  return command;
}

Liveness liveness_of(const ProcessIdentity& process) {
  if (process.machine != machine_of_this_process()) return Liveness::unknown;
  if (process.number <= 0 || !has_process(process.number)) return Liveness::dead;
  const auto state = state_of(process.number);
  if (!state) return Liveness::alive;  // the kernel hides processes of other users
  const bool has_ended = state->state == 'Z' || state->state == 'X';
  return has_ended || state->start != process.start ? Liveness::dead : Liveness::alive;
}

std::string unique_name() {
  static std::atomic<unsigned> made = 0;
  const ProcessIdentity process = this_process();
  return fmt::format("{}-{}-{}-{}", machine_in_name(process), process.number, process.start, made++);
}

Liveness liveness_of_maker(std::string_view name) {
  ProcessIdentity maker = this_process();
  std::istringstream fields{std::string(name)};
  std::string machine;
  char dash = 0;
  std::getline(fields, machine, '-');
  fields >> maker.number >> dash >> maker.start;
  return fields && machine == machine_in_name(maker) ? liveness_of(maker) : Liveness::unknown;
}

}  // namespace crisp::files
