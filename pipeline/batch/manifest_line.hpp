// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

#include "pipeline/batch/manifest.hpp"

namespace crisp::batch {

std::string_view name_of(BatchEventKind kind);

/// Reads a line of a manifest up to the keys that only a table needs, `exit` or `results` and what follows:
/// most of the text of a million lines is never parsed. Unknown keys are skipped.
/// @return nothing if the line is no event
std::optional<BatchEvent> parse_manifest_line(std::string_view line);

}  // namespace crisp::batch
