// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <crisp/rig.hpp>

#include "pipeline/files/yaml_map.hpp"

namespace crisp::files {

/// Reads the `line` of a rig's plate. Mistakes are added to `errors`.
EncoderLine read_encoder_line(const YamlNode& node, std::vector<Error>& errors);

}  // namespace crisp::files
