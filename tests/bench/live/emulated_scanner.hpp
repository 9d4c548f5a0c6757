// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grabbers/emulate/emulated_faults.hpp"
#include "grabbers/simulate/recording.hpp"

namespace crisp {

struct Trial {
  double seconds = 60;  ///< of the emulated scanner's time
  double speed = 1;     ///< times real time
  double faults = 0;    ///< share of the scans with each kind of fault; restarts a third of it
};

/// The scanner's report when it has sent everything.
struct Sent {
  std::uint64_t scans = 0, readings = 0;
  emulate::EmulatedLedger ledger;
};

simulate::RecordingSettings recording_of(const Trial& trial);
emulate::EmulatedFaults faults_of(const Trial& trial);
/// The default rig at 127.0.0.1, at ports that nobody uses just now.
Rig rig_with_free_ports();

/// An emulated scanner in a process of its own, so that what it costs is not counted as what is tried.
class ScannerProcess {
 public:
  /// @param program  that calls be_the_scanner(), as this one does: one without sanitizers is as fast as a
  /// scanner
  /// @throws Error if the process cannot be made
  ScannerProcess(const Trial& trial, const Rig& rig, const std::string& program);
  ~ScannerProcess();  ///< ends the devices
  ScannerProcess(const ScannerProcess&) = delete;
  ScannerProcess& operator=(const ScannerProcess&) = delete;

  /// Waits until everything is sent; nothing if the process failed. The devices stay where they are.
  std::optional<Sent> await_end() const;

 private:
  int reported_ = -1;  ///< pipe for its report
  pid_t process_ = -1;
};

/// What a program does that a ScannerProcess began, with the words that it was given. Does not return.
[[noreturn]] void be_the_scanner(const std::vector<std::string>& words);
inline constexpr const char* kBeTheScanner = "scanner";  ///< the first of these words

}  // namespace crisp
