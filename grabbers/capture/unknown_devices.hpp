// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/capture_statistics.hpp>

namespace crisp::capture {

/// The devices that speak in any of the captures and that the rig does not have, for people:
/// "laser at 10.0.0.7:2112, plate at 10.0.0.10:4000"; empty if there is none.
std::string unknown_devices(const std::vector<CaptureStatistics>& captures);

/// Caveats of the captures: a device of the rig sent nothing in any of them, while an unknown device of its
/// kind did. The rig's address is probably wrong, and the data of that device are missing.
std::vector<std::string> caveats_of_addresses(const std::vector<CaptureStatistics>& captures);

}  // namespace crisp::capture
