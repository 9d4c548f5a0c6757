// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "grabbers/simulate/scene.hpp"
#include "pipeline/files/yaml_map.hpp"

namespace crisp::simulate {

/// Geometry of an item of a scene's file: the one box, rectangle, polygon, run of walls, cylinder, sphere,
/// ellipsoid or shape that it names. Boxes are six flat surfaces, or one body if the item is foliage or
/// walks.
///
/// @param shapes  described before, by name
/// @param errors  receives the errors
Scene read_geometry(files::YamlMap& item, const Place& place, const std::map<std::string, Scene>& shapes,
                    std::vector<Error>& errors);

}  // namespace crisp::simulate
