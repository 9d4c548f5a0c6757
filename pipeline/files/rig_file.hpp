// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "pipeline/data/rig.hpp"
#include "pipeline/files/yaml.hpp"

namespace crisp {

/// Reads a rig: see configs/rig.yaml for the keys. Values may carry units (`45deg`, `20cm`); plain numbers
/// are SI and radians.
/// @throws Errors  all that is wrong, with file:line:column
Rig parse_rig(const YamlNode& root);

/// Reads the file and parses it. @throws Error if it cannot be read; Errors as parse_rig
Rig read_rig(const std::filesystem::path& file);

}  // namespace crisp
