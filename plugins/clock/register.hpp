// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::clock {

/// The stages clock.convex_hull, clock.online and clock.receipt.
void register_clock(Registrar& registrar);

}  // namespace crisp::clock
