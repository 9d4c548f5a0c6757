// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/registry.hpp"

namespace crisp {

/// grabber.bag, and what `crisp info` says of bags.
void register_bag(Registrar& registrar);

}  // namespace crisp
