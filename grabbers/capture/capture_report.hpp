// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include <crisp/capture_statistics.hpp>

namespace crisp::capture {

/// Title of a device: its name in the rig and its address, "laser1 (192.168.0.1:2112)".
std::string title(const DeviceStatistics& device);

/// Number of its lost items, by the device's own counter.
std::uint64_t never_came(const DeviceStatistics& device);

/// The statistics for programs. Times in s since the Unix epoch, durations in s, angles in rad.
nlohmann::json to_json(const CaptureStatistics& statistics);

/// Packets, bytes, and when the recording was made: one line.
std::string extent_of(const CaptureStatistics& statistics);

/// One line a device: items, rates, losses, silences, the shape of its scans.
std::string device_table(const CaptureStatistics& statistics);

/// All of the statistics, for people: the table, telegrams by kind, losses, and what was out of the ordinary.
std::string to_text(const CaptureStatistics& statistics);

}  // namespace crisp::capture
