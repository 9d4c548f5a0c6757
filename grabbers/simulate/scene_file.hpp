// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "grabbers/simulate/scene.hpp"
#include "pipeline/files/yaml.hpp"

namespace crisp::simulate {

/// Reads a scene: see configs/scenes/office.yaml for the keys. Lengths may carry units; plain numbers are in
/// m and rad.
/// @return the scene as seen from its scanner
/// @throws Errors  all that is wrong, with file:line:column
Scene parse_scene(const files::YamlNode& root);

/// Reads the file and parses it. @throws Error if it cannot be read; Errors as parse_scene
Scene read_scene(const std::filesystem::path& file);

}  // namespace crisp::simulate
