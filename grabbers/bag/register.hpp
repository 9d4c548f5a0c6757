// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::bag {

/// Registers grabber.bag, and the inspector of bags for `crisp info`.
void register_bag(Registrar& registrar);

}  // namespace crisp::bag
