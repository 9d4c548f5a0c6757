// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <crisp/rig.hpp>

namespace crisp {

/// Reads a rig's file: see docs/reference/rig-file.md for the keys. Values may carry units (`45deg`, `20cm`);
/// plain numbers are SI and radians.
/// @throws Error   if the file cannot be read
/// @throws Errors  all that is wrong in it, with file:line:column
Rig read_rig(const std::filesystem::path& file);

}  // namespace crisp
