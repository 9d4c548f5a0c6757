// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "pipeline/data/findings.hpp"
#include "pipeline/files/yaml.hpp"

namespace crisp {

/// What a diagnosis says, as JSON for programs: docs/diagnosis.md has its schema.
std::string findings_json(const Findings& findings);

/// Reads what findings_json() writes; JSON is YAML. A number that is `null` there becomes NaN.
///
/// @throws Error or Errors  with file:line:column: keys that are missing or not known, values that do not fit
Findings parse_findings(const YamlNode& root);
Findings read_findings(const std::filesystem::path& file);

}  // namespace crisp
