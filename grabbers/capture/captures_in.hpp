// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

namespace crisp {

/// The captures that a path stands for: a file stands for itself, a folder for the captures in it, but not in
/// folders of its own, in the order of their first packets.
/// @throws Error if a folder cannot be read or holds no capture
std::vector<std::filesystem::path> captures_in(const std::filesystem::path& path);

}  // namespace crisp
