// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/registry.hpp"

namespace crisp {

/// The stages clock.convex_hull, clock.online and clock.receipt.
void register_clock(Registrar& registrar);

}  // namespace crisp
