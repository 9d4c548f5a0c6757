// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/source_dir.hpp"

namespace crisp {

std::string source_dir() { return CRISP_SOURCE_DIR; }

}  // namespace crisp
