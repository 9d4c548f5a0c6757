// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/registry.hpp"

namespace crisp {

/// grabber.table.
void register_table(Registrar& registrar);

}  // namespace crisp
