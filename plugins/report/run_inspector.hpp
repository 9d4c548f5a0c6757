// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::report {

/// Describes the summary.json of a run.
Inspector run_inspector();

}  // namespace crisp::report
