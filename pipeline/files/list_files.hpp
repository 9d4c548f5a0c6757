// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace crisp::files {

/// The files in a folder, but not in folders of its own, by their names.
/// @throws Error if the folder cannot be read
std::vector<std::filesystem::path> list_files(const std::filesystem::path& folder);

/// Whether a file's name ends in one of some extensions, ".pcap", written large or small, digits behind it or
/// none: tcpdump writes hub.pcap, hub.pcap1 and so on.
bool has_extension(const std::filesystem::path& file, const std::vector<std::string>& extensions);

}  // namespace crisp::files
