// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

namespace crisp {

/// The files in a folder, but not in folders of its own, by their names.
/// @throws Error if the folder cannot be read
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);

}  // namespace crisp
