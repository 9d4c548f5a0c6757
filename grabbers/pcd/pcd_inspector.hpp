// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/inspector.hpp"

namespace crisp {

/// Says what a PCD file holds, of crisp or of any other program: points, fields, and how far each reaches.
Inspector pcd_inspector();

}  // namespace crisp
