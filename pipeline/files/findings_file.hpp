// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include <crisp/findings.hpp>

#include "pipeline/files/renamed_names.hpp"
#include "pipeline/files/yaml.hpp"

namespace crisp::files {

/// Findings as JSON for programs: docs/reference/diagnosis-json.md has its schema.
std::string findings_json(const Findings& findings);

/// Reads what findings_json() writes; JSON is YAML. A number that is `null` there becomes NaN.
///
/// @throws Error or Errors  with file:line:column: keys that are missing or not known, values that do not fit
Findings parse_findings(const YamlNode& root);

/// The same of a file. Keys of an earlier release are accepted.
/// @param warn  receives a warning for each such key
Findings read_findings(const std::filesystem::path& file, const OldNameSink& warn = {});

}  // namespace crisp::files
