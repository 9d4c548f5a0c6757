// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/scan.hpp>

#include "grabbers/wire/scan_data.hpp"

namespace crisp::wire {

/// Encodes a scan as the telegram that it was decoded from, as far as the scan determines it: decoded again,
/// it gives the same ranges [whole millimetres, rounded beyond 65 m], angles, counters and times. A code that
/// the device sent for a range is 0 afterwards.
/// @throws Error if a range or an angle is beyond the telegram's limits
ScanData to_scan_data(const Scan& scan);

}  // namespace crisp::wire
