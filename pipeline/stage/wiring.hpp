// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <crisp/pipeline.hpp>

namespace crisp::stage {

/// Fills in `feeders` of every node, and adds an error for each input that nothing feeds and for each entry
/// of `inputs` that feeds nothing. Nodes whose stage is unknown are skipped: their error is already reported.
void connect(Pipeline& pipeline, const std::vector<StageSpec>& specs, const StageRegistry& registry,
             std::vector<Error>& errors);

/// A warning for each stage below all stages that would take its items: a filter under the writer, for
/// example. Requires a connected pipeline.
std::vector<PipelineWarning> put_too_low(const Pipeline& pipeline);

}  // namespace crisp::stage
