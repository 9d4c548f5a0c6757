// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "plugins/report/page.hpp"

namespace crisp {

/// The page of a run, but for its calibration, findings and cloud: verdict, devices, origin, and the plots
/// that its stages drew.
///
/// @param summary  what summary.json holds
/// @param folder   where plots are that are no longer where the run wrote them; empty: nowhere
PageContent run_content(const nlohmann::ordered_json& summary, const std::filesystem::path& folder = {});

}  // namespace crisp
