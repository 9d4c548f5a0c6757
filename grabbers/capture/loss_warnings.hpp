// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "grabbers/capture/capture_statistics.hpp"

namespace crisp {

/// What a person should know of a source before trusting what is made of it: each device of the rig of which
/// more than one item in a hundred never came or could not be read, and a file that is damaged to that degree
/// or ends too early.
/// @param source  what the warnings call it: the file's name; empty for devices that are live
std::vector<std::string> loss_warnings(const CaptureStatistics& statistics, const std::string& source = "");

/// Caveats on lasers of the rig of which hardly any scan could be read.
std::vector<std::string> lost_devices(const CaptureStatistics& statistics);

/// Caveats on lasers of the rig whose scans come from several units in turn, by their serial numbers: two
/// units have one address, and their scans are no sequence. (A unit that was replaced once is none.)
std::vector<std::string> address_conflicts(const CaptureStatistics& statistics);

}  // namespace crisp
