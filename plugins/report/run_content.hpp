// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "plugins/report/page.hpp"

namespace crisp::report {

/// The report of a run without its calibration, findings and cloud: verdict, devices, provenance, and the
/// stages' plots.
///
/// @param summary  the content of summary.json
/// @param folder   fallback folder of plots that have moved since the run; empty: none
PageContent run_content(const nlohmann::ordered_json& summary, const std::filesystem::path& folder = {});

}  // namespace crisp::report
