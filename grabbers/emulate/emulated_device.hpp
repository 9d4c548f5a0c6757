// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "grabbers/wire/scan_data.hpp"
#include "grabbers/wire/scan_settings.hpp"

namespace crisp {

/// What an emulated laser is, for all who are connected to it. It scans as the scans that it is given, and
/// cannot scan otherwise; which part of them it sends can be set.
struct EmulatedDevice {
  std::string name = "LMS1xx";  ///< that it identifies itself with
  std::string firmware = "V1.80.2";
  bool measuring = true;
  ScanData last;                       ///< what is answered to who asks for one scan
  std::optional<OutputRange> range;    ///< that somebody set
  std::optional<ScanContent> content;  ///< likewise

  /// How its scans are.
  ScanSettings settings() const;
  OutputRange output_range() const;

  /// What of a scan it sends, as it is set.
  ScanData sent(ScanData scan) const;
};

}  // namespace crisp
