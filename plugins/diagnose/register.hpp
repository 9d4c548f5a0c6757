// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::diagnose {

void register_diagnose(Registrar& registrar);

}  // namespace crisp::diagnose
