// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "pipeline/files/yaml.hpp"

namespace crisp {

/// What one of crisp's YAML files describes.
enum class FileKind { unknown, pipeline, rig, calibration };

/// By its keys, right or wrong as their values may be.
FileKind kind_of(const YamlNode& root);

/// Pipelines, rigs and calibrations lie beside each other, and are easily given in each other's place.
/// @throws Error that says what the file is, if it is known to be of another kind
void refuse_other_kinds(const YamlNode& root, const std::filesystem::path& file, FileKind wanted);

}  // namespace crisp
