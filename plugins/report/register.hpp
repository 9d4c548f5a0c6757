// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::report {

void register_report(Registrar& registrar);

}  // namespace crisp::report
