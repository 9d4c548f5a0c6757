// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/calibration_file.hpp>

#include "pipeline/files/yaml.hpp"

namespace crisp::files {

/// Reads a calibration.
/// @param judge  none: any term with any parameters will do
/// @throws Errors  all that is wrong, with file:line:column
Calibration parse_calibration(const YamlNode& root, const JudgeTerm& judge = {});

}  // namespace crisp::files
