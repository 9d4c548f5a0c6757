// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace crisp {

/// A process, described so that other processes can find out later whether it still runs.
struct ProcessIdentity {
  std::string host;         ///< name of its machine, for people
  std::string machine;      ///< within which a process number means one process: boot and PID namespace
  pid_t number = 0;         ///< its process number
  std::uint64_t start = 0;  ///< [clock ticks since boot] tells it from a later process of the same number

  bool operator==(const ProcessIdentity&) const = default;
};

/// The calling process.
ProcessIdentity this_process();

/// The command line that started it, its words parted by spaces; empty where the system does not tell.
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

/// Of the process on this machine that made such a name, whether it lives; unknown of one on another machine,
/// and of a name that is none.
Liveness liveness_of_maker(std::string_view unique_name);

}  // namespace crisp
