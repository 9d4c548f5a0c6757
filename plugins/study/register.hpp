// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::study {

void register_study(Registrar& registrar);

}  // namespace crisp::study
