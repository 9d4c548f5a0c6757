// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::pcd_grabber {

/// Describes a PCD file of crisp or of any other program: points, fields, and the range of each.
Inspector pcd_inspector();

}  // namespace crisp::pcd_grabber
