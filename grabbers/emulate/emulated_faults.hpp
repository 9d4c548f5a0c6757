// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include "grabbers/wire/bytes.hpp"

namespace crisp {

/// What befalls an emulated laser's telegrams; shares from 0 to 1.
struct EmulatedFaults {
  double dropped = 0;  ///< of scans, in whose place the connection is closed
  double stalled = 0;  ///< of telegrams, before which nothing is sent for a while
  double stall = 0.1;  ///< [s] that while
  double split = 0;    ///< of telegrams, sent in pieces of any length
  double damaged = 0;  ///< of scans, with one bit flipped
  std::uint64_t seed = 1;
};

/// Decides, the same for the same seed, which telegram what befalls.
class FaultDice {
 public:
  explicit FaultDice(const EmulatedFaults& faults, std::uint64_t laser)
      : faults_(faults), random_(faults.seed * 1000003 + laser) {}

  bool drops() { return chance(faults_.dropped); }
  bool stalls() { return chance(faults_.stalled); }
  double stall() const { return faults_.stall; }
  bool damages() { return chance(faults_.damaged); }

  /// How much of what is left of a telegram is sent at once.
  std::size_t piece(std::size_t left) {
    return left > 1 && chance(faults_.split) ? 1 + random_() % (left - 1) : left;
  }

  void flip_a_bit(Bytes& telegram) {
    telegram[random_() % telegram.size()] ^= static_cast<std::uint8_t>(1U << (random_() % 8));
  }

 private:
  bool chance(double share) { return static_cast<double>(random_() >> 11) * 0x1p-53 < share; }

  EmulatedFaults faults_;
  std::mt19937_64 random_;
};

}  // namespace crisp
