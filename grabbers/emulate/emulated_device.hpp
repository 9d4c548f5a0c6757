// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "grabbers/wire/scan_data.hpp"
#include "grabbers/wire/scan_settings.hpp"

namespace crisp::emulate {

/// State of an emulated laser, common to all its clients. It scans as the given scans do, and
/// cannot scan otherwise; the sent part of them can be configured: angles, every so many beams and scans,
/// remissions and their width, encoder and time.
struct EmulatedDevice {
  std::string name = "LMS1xx";  ///< that it identifies itself with
  std::string firmware = "V1.80.2";
  bool measuring = true;
  wire::ScanData last;                          ///< the answer to a request for one scan
  std::optional<wire::OutputRange> range;       ///< that somebody set
  std::optional<wire::ScanContent> configured;  ///< likewise
  std::uint32_t every_beam = 1;                 ///< one of so many is sent, likewise

  /// How its scans are.
  wire::ScanSettings settings() const;
  wire::OutputRange output_range() const;
  /// The content of its scans: as somebody set it, or as they came.
  wire::ScanContent content() const;

  /// Sets a resolution of which the scans' is a part. @return whether it is one
  bool set_resolution(std::uint32_t resolution);
  /// Whether a scan is one of those that are sent, of every so many.
  bool sends(const wire::ScanData& scan) const;
  /// The configured part of a scan.
  wire::ScanData sent(wire::ScanData scan) const;
};

}  // namespace crisp::emulate
