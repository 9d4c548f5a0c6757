// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::write {

void register_write(Registrar& registrar);

}  // namespace crisp::write
