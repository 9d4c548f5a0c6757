// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/wire/scan_data.hpp"
#include "pipeline/data/scan.hpp"

namespace crisp {

/// The telegram that a scan was decoded from, as far as the scan tells: decoded again, it gives the same
/// ranges [whole millimetres, or what is left of them beyond 65 m], angles, counters and times. A code that
/// the device sent for a range is 0 afterwards.
/// @throws Error if a range or an angle is beyond what a telegram can say
ScanData to_scan_data(const Scan& scan);

}  // namespace crisp
