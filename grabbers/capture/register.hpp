// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::capture {

/// Registers grabber.capture, and the inspector of captures for `crisp info`.
void register_capture(Registrar& registrar);

}  // namespace crisp::capture
