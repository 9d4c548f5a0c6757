// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::assemble {

void register_assemble(Registrar& registrar);

}  // namespace crisp::assemble
