// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::filter {

void register_filter(Registrar& registrar);

}  // namespace crisp::filter
