// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

#include "pipeline/batch/manifest.hpp"

namespace crisp {

std::string_view name_of(BatchEventKind kind);

/// Reads a line of a manifest up to its key `results`, which is the last one where it is: of a million lines
/// most of the text is never parsed. Keys that are not known are passed over.
/// @return nothing if it is no event
std::optional<BatchEvent> parse_manifest_line(std::string_view line);

}  // namespace crisp
