// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/registry.hpp"

namespace crisp {

void register_watch(Registrar& registrar);

}  // namespace crisp
