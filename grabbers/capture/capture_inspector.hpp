// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::capture {

/// Describes a capture's content, from any sender; devices at an address of the rig get its names.
Inspector capture_inspector();

}  // namespace crisp::capture
