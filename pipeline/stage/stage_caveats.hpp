// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/stage/stage_worker.hpp"

namespace crisp::stage {

/// Turns the caveats that stages below have resolved (Context::resolve_caveats) into warnings.
void resolve_caveats(StageWorkers& workers);

/// Unresolved caveats of the stages above, on items that reach the stage at `index`.
std::vector<std::string> caveats_above(const StageWorkers& workers, std::size_t index);

}  // namespace crisp::stage
