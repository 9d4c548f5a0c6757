// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/inspector.hpp"

namespace crisp {

/// Says what a diagnosis.json holds.
Inspector findings_inspector();

}  // namespace crisp
