// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::diagnose {

/// diagnose.stationary, diagnose.sweep, diagnose.passes and diagnose.mounting.
void register_scans(Registrar& registrar);

}  // namespace crisp::diagnose
