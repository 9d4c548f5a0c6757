// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "grabbers/capture/capture_statistics.hpp"

namespace crisp {

/// The devices that speak in any of the captures and that the rig does not have, for people:
/// "laser at 10.0.0.7:2112, plate at 10.0.0.10:4000"; empty if there is none.
std::string strangers(const std::vector<CaptureStatistics>& captures);

/// Why what the captures give cannot be trusted: of a device of the rig nothing came in any of them, while
/// one of its kind that the rig does not have spoke. The rig's address is probably wrong, and the data of
/// that device are missing.
std::vector<std::string> doubts_of_addresses(const std::vector<CaptureStatistics>& captures);

}  // namespace crisp
