// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "pipeline/files/yaml.hpp"

namespace crisp::files {

/// Kind of one of crisp's YAML files.
enum class FileKind { unknown, pipeline, rig, calibration };

/// By its keys, right or wrong as their values may be.
FileKind kind_of(const YamlNode& root);

/// Pipelines, rigs and calibrations lie next to each other, and are easily mistaken for each other.
/// @throws Error that names the file's kind, if it is known to be of another kind
void refuse_other_kinds(const YamlNode& root, const std::filesystem::path& file, FileKind requested);

}  // namespace crisp::files
