// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/inspector.hpp>

namespace crisp::diagnose {

/// Inspector of a diagnosis.json.
Inspector findings_inspector();

}  // namespace crisp::diagnose
