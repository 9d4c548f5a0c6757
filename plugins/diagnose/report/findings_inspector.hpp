// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::diagnose {

/// Inspector of a diagnosis.json.
Inspector findings_inspector();

}  // namespace crisp::diagnose
