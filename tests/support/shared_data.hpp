// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>

#include "tests/support/source_dir.hpp"

namespace crisp {

/// Where data that is shared but not in the repository lies: $CRISP_SHARED_DATA or ../shared/data.
inline std::filesystem::path shared_data() {
  if (const char* place = std::getenv("CRISP_SHARED_DATA")) return place;
  return std::filesystem::path(source_dir()) / "../shared/data";
}

}  // namespace crisp
