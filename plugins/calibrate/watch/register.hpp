// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::calibrate {

void register_watch(Registrar& registrar);

}  // namespace crisp::calibrate
