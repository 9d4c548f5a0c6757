// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/rig_file.hpp>

#include "pipeline/files/yaml.hpp"

namespace crisp::files {

/// Reads a rig: see configs/rig.yaml for the keys. Values may carry units (`45deg`, `20cm`); plain numbers
/// are SI and radians.
/// @throws Errors  all that is wrong, with file:line:column
Rig parse_rig(const YamlNode& root);

}  // namespace crisp::files
