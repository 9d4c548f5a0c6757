// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "tests/independent/population.hpp"
#include "tests/independent/scanner.hpp"

namespace independent {

/// The numbers of a telegram that change from scan to scan.
struct ScanHeader {
  std::uint32_t serial = 0, stamp_us = 0, transmission_us = 0;
  std::uint16_t telegram_counter = 0, scan_counter = 0;
  double seconds_since_start = 0;  ///< of the calendar clock, where the telegram has one
};

/// A scan as a framed `sSN LMDscandata` in CoLa-A or CoLa-B (sick-cola.md).
std::string scan_telegram(const LaserKind& kind, const std::string& name, const WireSetup& wire,
                          const ScanHeader& header, const Scan& scan);

/// A framed command or answer with one parameter of 8 bits, such as `sEN LMDscandata 1`.
std::string short_telegram(const std::string& command, int parameter, bool is_text);

/// A reading as the plate's sentence (plate.md).
std::string plate_sentence(std::uint16_t sequence, std::uint32_t device_us, std::uint32_t count);

}  // namespace independent
