// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <crisp/live_settings.hpp>
#include <crisp/scan.hpp>

namespace crisp::live {

/// @throws Error if the range is not two ascending angles within a turn
void check(const SickConfiguration& configuration);

/// Difference between a scan and the requested settings, in words; or "". A laser's reported settings may
/// differ from its measurement, so that the scan is decisive.
std::string difference(const SickConfiguration& requested, const Scan& scan);

}  // namespace crisp::live
