// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace crisp::batch {

/// Whether a path is a pattern: has one of `*`, `?` and `[`.
bool is_pattern(const std::string& path);

/// The folders of a pattern above its first wildcard: "captures" of "captures/**/*.pcap".
std::filesystem::path fixed_part(const std::string& pattern);

/// The files and folders that match, sorted: `*`, `?` and `[…]` within a name as in a shell, `**` for any
/// number of folders. What begins with a dot is matched only by what begins with one.
std::vector<std::filesystem::path> match_pattern(const std::string& pattern);

}  // namespace crisp::batch
