// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/inspector.hpp"

namespace crisp {

/// What a bag holds, for `crisp info`.
Inspector bag_inspector();

}  // namespace crisp
