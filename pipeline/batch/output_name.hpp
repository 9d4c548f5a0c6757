// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace crisp::batch {

/// Files of a batch itself in its output folder.
inline constexpr const char* kBatchManifest = "manifest";  ///< a folder, in it a folder a task
inline constexpr const char* kBatchSummary = "batch.json";
inline constexpr const char* kBatchTable = "table.csv";
inline constexpr const char* kBatchReport = "report.html";
inline constexpr const char* kBatchTrend = "trend.svg";

/// A recording's path as a name: control characters and invalid UTF-8 become %XX, as does "%" where one of
/// them follows.
std::string output_name(std::string_view path);

/// Whether a recording of this name would write where the batch itself does.
bool is_reserved_output(std::string_view name);

}  // namespace crisp::batch
