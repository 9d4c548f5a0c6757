// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/data/findings.hpp"

namespace crisp {

/// What a diagnosis says, as JSON for programs: docs/diagnosis.md has its schema.
std::string findings_json(const Findings& findings);

}  // namespace crisp
