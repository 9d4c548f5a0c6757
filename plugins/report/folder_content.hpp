// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <crisp/calibration.hpp>

#include "plugins/report/page.hpp"

namespace crisp::report {

/// Settings of a folder's page.
struct FolderPageSettings {
  std::size_t points = 300'000;        ///< most points of the cloud
  Calibration nominal;                 ///< the rig's values
  std::optional<Calibration> against;  ///< an earlier calibration
};

struct FolderPage {  // NOLINT(bugprone-exception-escape): moving JSON checks what it holds
  PageContent content;
  std::vector<std::filesystem::path> read;
};

/// The page of what a run or a batch left in a folder.
/// @throws Error  if it holds neither, or a file that is damaged
FolderPage folder_page(const std::filesystem::path& folder, const FolderPageSettings& settings);

}  // namespace crisp::report
