// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>

namespace crisp {

/// Where data that is shared but not in the repository lies: $CRISP_SHARED_DATA or ../shared/data.
inline std::filesystem::path shared_data() {
  if (const char* place = std::getenv("CRISP_SHARED_DATA")) return place;
  return std::filesystem::path(CRISP_SOURCE_DIR) / "../shared/data";
}

}  // namespace crisp
