// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/capture_statistics.hpp>

namespace crisp::capture {

/// Warnings of a source's losses: each device of the rig of which more than one item in a hundred was lost or
/// unreadable, and a file that is damaged to that degree or truncated, or whose packets are.
/// @param source  its name in the warnings: the file's name; empty for live devices
std::vector<std::string> loss_warnings(const CaptureStatistics& statistics, const std::string& source = "");

/// How many packets the recording cut off, and what to do.
std::string truncated_packets(const CaptureStatistics& statistics);

/// Caveats on lasers of the rig of which hardly any scan could be read.
std::vector<std::string> lost_devices(const CaptureStatistics& statistics);

/// Caveats on lasers of the rig whose scans come from several units in turn, by their serial numbers: two
/// units have one address, and their scans are no sequence. (A unit that was replaced once is none.)
std::vector<std::string> address_conflicts(const CaptureStatistics& statistics);

}  // namespace crisp::capture
