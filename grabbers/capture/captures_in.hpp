// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace crisp::capture {

/// File name extensions of captures: see has_extension().
inline std::vector<std::string> capture_extensions() { return {".pcap", ".pcapng", ".cap"}; }

/// The captures that a path stands for.
struct Captures {
  std::vector<std::filesystem::path> files;  ///< in the order of their first packets
  /// Why a file of a folder that is a capture by its name or its first bytes is not among them.
  std::vector<std::string> left_out;
};

/// Lists the captures of a path: a file stands for itself, a folder for the captures in it, without
/// subfolders. Files that are no captures by their names may lie next to them.
/// @throws Error if a folder cannot be read or holds no capture
Captures captures_in(const std::filesystem::path& path);

}  // namespace crisp::capture
