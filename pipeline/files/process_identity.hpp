// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace crisp::files {

/// A process, described so that other processes can find out later whether it still runs.
struct ProcessIdentity {
  std::string host;     ///< name of its machine, for people
  std::string machine;  ///< within which a process number means one process: boot and PID namespace
  pid_t number = 0;     ///< its process number
  std::uint64_t start =
      0;  ///< [clock ticks since boot] distinguishes it from a later process of the same number

  bool operator==(const ProcessIdentity&) const = default;
};

/// The calling process.
ProcessIdentity this_process();

/// The command line that started it, its words separated by spaces; empty where the system does not provide
/// it.
std::string command_of_this_process();

enum class Liveness {
  alive,
  dead,
  unknown,  ///< it belongs to another machine, another boot or another container
};

Liveness liveness_of(const ProcessIdentity& process);

/// A part of a file's name that no other process, past or future, on whichever machine, gives to a file:
/// "MACHINE-NUMBER-START-COUNT".
std::string unique_name();

/// Whether the process that made such a name on this machine lives; unknown for another machine, and for an
/// invalid name.
Liveness liveness_of_maker(std::string_view unique_name);

}  // namespace crisp::files
