// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <type_traits>
#include <vector>

#include "grabbers/wire/bytes.hpp"

namespace crisp::emulate {

/// Faults of an emulated scanner; shares from 0 to 1.
struct EmulatedFaults {
  double dropped = 0;    ///< of scans, in whose place the connection is closed
  double stalled = 0;    ///< of telegrams, before which nothing is sent for a while
  double stall = 0.1;    ///< [s] that while
  double split = 0;      ///< of telegrams, sent in pieces of any length
  double damaged = 0;    ///< of scans and of the plate's sentences, with one bit flipped
  double restarted = 0;  ///< of scans, before which the laser starts again: its clock and counters at zero
  double lost = 0;       ///< of the plate's datagrams, that are not sent
  std::vector<double> skews = {};  ///< by how much each laser's clock runs fast: 1e-6 is 1 ppm
  std::uint64_t seed = 1;
};

/// Counts of its faults.
struct EmulatedLedger {
  std::uint64_t delivered = 0;  ///< scans that were sent whole, once for each client
  std::uint64_t unheard = 0;    ///< scans that nobody had subscribed to when they were due
  std::uint64_t dropped = 0;    ///< scans in whose place the connection was closed
  std::uint64_t damaged = 0;    ///< scans with a bit flipped
  std::uint64_t missed = 0;     ///< scans that a client missed because it did not read
  std::uint64_t stalled = 0;    ///< telegrams that were sent late
  std::uint64_t restarted = 0;  ///< times that a laser started again
  std::uint64_t readings = 0;   ///< of the plate, sent whole
  std::uint64_t readings_damaged = 0;
  std::uint64_t readings_lost = 0;

  EmulatedLedger& operator+=(const EmulatedLedger& other) {
    for (auto member : {&EmulatedLedger::delivered, &EmulatedLedger::unheard, &EmulatedLedger::dropped,
                        &EmulatedLedger::damaged, &EmulatedLedger::missed, &EmulatedLedger::stalled,
                        &EmulatedLedger::restarted, &EmulatedLedger::readings,
                        &EmulatedLedger::readings_damaged, &EmulatedLedger::readings_lost}) {
      this->*member += other.*member;
    }
    return *this;
  }
  /// Faults of all kinds.
  std::uint64_t faults() const {
    return dropped + damaged + stalled + restarted + readings_damaged + readings_lost;
  }
};

/// Draws the fault of each telegram, the same for the same seed.
class FaultDice {
 public:
  explicit FaultDice(const EmulatedFaults& faults, std::uint64_t device)
      : faults_(faults), random_(faults.seed * 1000003 + device) {}

  bool drops() { return chance(faults_.dropped); }
  bool stalls() { return chance(faults_.stalled); }
  double stall() const { return faults_.stall; }
  bool damages() { return chance(faults_.damaged); }
  bool restarts() { return chance(faults_.restarted); }
  bool loses() { return chance(faults_.lost); }

  /// Size of the next piece of a telegram.
  std::size_t piece(std::size_t left) {
    return left > 1 && chance(faults_.split) ? 1 + random_() % (left - 1) : left;
  }

  /// @param telegram  of bytes of 8 bits
  template <class Telegram>
  void flip_a_bit(Telegram& telegram) {
    auto& byte = telegram[random_() % telegram.size()];
    byte = static_cast<std::remove_reference_t<decltype(byte)>>(byte ^ (1U << (random_() % 8)));
  }

 private:
  bool chance(double share) { return share > 0 && static_cast<double>(random_() >> 11) * 0x1p-53 < share; }

  EmulatedFaults faults_;
  std::mt19937_64 random_;
};

}  // namespace crisp::emulate
