// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace crisp::batch {

/// The event of the batch that began last in an output folder; null if none did. Nothing else of the
/// manifests is kept or parsed.
/// @throws Error if a manifest cannot be read
nlohmann::ordered_json last_batch(const std::filesystem::path& output);

}  // namespace crisp::batch
