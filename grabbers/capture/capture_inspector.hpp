// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/inspector.hpp"

namespace crisp {

/// Says what a capture holds, whoever sent it; devices at an address of the rig get its names.
Inspector capture_inspector();

}  // namespace crisp
