// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/registry.hpp"

namespace crisp {

/// The stage grabber.capture, and what `crisp info` says of captures.
void register_capture(Registrar& registrar);

}  // namespace crisp
